#pragma once

// An ADIS16405 as a device of a driver: found, started, read, and found again.

#include <memory>
#include <optional>
#include <string>

#include "drivers/adis16405/burst_reader.h"
#include "drivers/plugin.h"

namespace imunoise::drivers::adis16405 {

/// Which device, and how.
struct Choice {
  std::string bridge = "any";  ///< "ft232h", "cp2130", or "any".
  std::string serial = {};     ///< Of the bridge; empty: the only one there is.
  bool poll = false;           ///< Read without data-ready, also where the bridge sees it.
  Settings settings = {};
};

/// Streams of describe_streams(). A sensor that falls silent for a second is started again; one
/// that is unplugged, or does not come back, is DISCONNECTED, and every read looks for the same
/// bridge until its time is over. A start-up takes about 0.6 s, during which a read neither times
/// out nor is cancelled.
class Adis16405Device final : public plugin::Device {
 public:
  /// Throws plugin::DeviceError: NOT_FOUND, BAD_OPTION (several devices, and no serial number
  /// chosen), NO_ACCESS, BAD_DEVICE.
  Adis16405Device(std::shared_ptr<usb::Bus> bus, Choice choice, const plugin::Host& host);

  DeviceInfo describe() override;
  void read(plugin::Samples& samples, const plugin::Wait& wait) override;

 private:
  // All that ends with the cable.
  struct Connection {
    Connection(std::unique_ptr<usb::Handle> usb, usb::Id id, const Choice& choice, const Note& note,
               const plugin::WireTap& wire);
    SpiBus bus;
    BurstReader reader;
  };

  usb::Address choose();
  std::optional<usb::Address> find_again();
  void connect(const usb::Address& address);
  void look_for_it(const plugin::Wait& wait);
  void restart();
  [[noreturn]] void lose(const std::string& why);

  std::shared_ptr<usb::Bus> usb_;
  Choice choice_;
  Note note_;
  plugin::WireTap wire_;
  usb::Address address_;
  std::unique_ptr<Connection> connection_;  // none: unplugged
  std::string why_lost_;
};

}  // namespace imunoise::drivers::adis16405
