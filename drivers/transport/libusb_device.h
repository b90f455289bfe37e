#pragma once

// A device that libusb has opened, with its transfers in flight.

#include <libusb.h>

#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/transport/libusb_bus.h"

namespace imunoise::drivers::usb {

using LibusbHandle = std::unique_ptr<libusb_device_handle, void (*)(libusb_device_handle*)>;

/// No thread of its own: transfers complete while one of its functions waits.
class LibusbDevice final : public Handle {
 public:
  /// Takes the first interface, from a kernel driver if need be, and starts to listen. Throws
  /// plugin::DeviceError: NO_ACCESS (in use by another program), FAILED.
  LibusbDevice(std::shared_ptr<libusb_context> context, LibusbHandle handle, Address address,
               HostClock clock);
  ~LibusbDevice() override;

  void control(const Request& request) override;
  void send(std::vector<std::uint8_t> bytes) override;
  std::vector<Transfer> receive(Duration timeout) override;
  Duration now() const override;
  void sleep(Duration duration) override;

 private:
  struct FreeTransfer {
    void operator()(libusb_transfer* transfer) const { libusb_free_transfer(transfer); }
  };
  // A transfer and its bytes, which are libusb's while it is in flight.
  struct Slot {
    LibusbDevice* owner;
    std::unique_ptr<libusb_transfer, FreeTransfer> transfer;
    std::vector<std::uint8_t> bytes;
    bool in_flight = false;
  };

  void claim();
  void find_endpoints();
  void submit(Slot& slot, std::uint8_t endpoint);
  Slot& add_slot(std::list<Slot>& slots);
  static void completed(libusb_transfer* transfer);
  void take(Slot& slot);
  void handle_events(Duration most);
  void cancel(std::list<Slot>& slots);
  [[noreturn]] void gone(const std::string& why) const;

  std::shared_ptr<libusb_context> context_;
  LibusbHandle handle_;
  Address address_;
  HostClock clock_;
  std::uint8_t in_endpoint_ = 0;
  std::uint8_t out_endpoint_ = 0;
  std::list<Slot> in_;   // a list does not move what it holds
  std::list<Slot> out_;  // used again when done
  std::vector<Transfer> arrived_;
  std::optional<std::string> failure_;  // why nothing will come any more
  std::optional<std::uint8_t> halted_;  // endpoint that refused a transfer
  bool closing_ = false;
};

}  // namespace imunoise::drivers::usb
