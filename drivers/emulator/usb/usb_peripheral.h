#pragma once

// A USB device seen from its cable: what an emulated bus, or an emulated kernel, drives.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/codec/bytes.h"
#include "drivers/emulator/usb/spi_slave.h"
#include "drivers/transport/usb.h"

namespace imunoise::emulator {

/// What its descriptors say.
struct UsbIdentity {
  drivers::usb::Id id;
  std::string serial;
  std::uint8_t in_endpoint = 0x81;   ///< Bulk.
  std::uint8_t out_endpoint = 0x02;  ///< Bulk.
  std::uint16_t packet_bytes = 512;
};

/// Its time passes in run() alone. Not thread-safe.
class UsbPeripheral {
 public:
  UsbPeripheral() = default;
  UsbPeripheral(const UsbPeripheral&) = delete;
  UsbPeripheral& operator=(const UsbPeripheral&) = delete;
  virtual ~UsbPeripheral() = default;

  virtual const UsbIdentity& identity() const = 0;
  /// It is plugged in: power comes, and time starts at 0.
  virtual void power_up() = 0;
  /// A vendor request; false: it refuses (stalls).
  virtual bool control(const drivers::usb::Request& request) = 0;
  /// Takes bytes of the OUT endpoint as far as there is room; returns how many.
  virtual std::size_t out(drivers::Bytes bytes) = 0;
  /// A packet for the IN endpoint, if one is ready.
  virtual std::optional<std::vector<std::uint8_t>> in() = 0;
  virtual Time now() const = 0;
  /// Does one thing, or waits until `until` where there is nothing to do. A packet that got ready
  /// should be taken before the next call: waiting for the host is told by the time it takes.
  virtual void run(Time until) = 0;
};

}  // namespace imunoise::emulator
