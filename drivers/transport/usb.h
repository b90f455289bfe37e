#pragma once

// USB as a driver needs it: vendor requests and one bulk endpoint each way, with many transfers in
// flight. Time belongs to it, so that an emulated bus may run faster than life. Trouble is thrown
// as plugin::DeviceError: NOT_FOUND, NO_ACCESS, DISCONNECTED (the device is disconnected), FAILED.

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/codec/bytes.h"

namespace imunoise::drivers::usb {

using Duration = std::chrono::nanoseconds;

/// What kind of device it is, as its maker registered it.
struct Id {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  friend bool operator==(const Id&, const Id&) = default;
};

/// A device that is plugged in.
struct Address {
  Id id;
  std::string port;    ///< Bus and ports on the way to it: "1-4.2".
  std::string serial;  ///< Empty where it has none, or may not be asked.
};

/// A vendor request from host to device (bmRequestType 0x40).
struct Request {
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  std::vector<std::uint8_t> data = {};
};

/// What one IN transfer brought.
struct Transfer {
  std::vector<std::uint8_t> bytes;
  std::int64_t host_time_ns = 0;  ///< When it was complete, ns since 1970-01-01 UTC.
};

/// IN transfers that are kept in flight, each of one packet of a high-speed device (512 bytes):
/// what the kernel takes while the program is held up.
inline constexpr std::size_t kTransfersInFlight = 128;
inline constexpr std::size_t kTransferBytes = 512;

/// An open device; its first interface is ours until destruction. One thread at a time.
class Handle {
 public:
  Handle() = default;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  virtual ~Handle() = default;

  /// Waits until the device has taken the request, at most 1 s.
  virtual void control(const Request& request) = 0;
  /// Queues bytes for the OUT endpoint as one transfer; returns at once.
  virtual void send(std::vector<std::uint8_t> bytes) = 0;
  /// All that came in, in order, waiting at most `timeout` for the first. Throws only where nothing
  /// is left to be taken.
  virtual std::vector<Transfer> receive(Duration timeout) = 0;

  /// A clock that never steps; any origin.
  virtual Duration now() const = 0;
  virtual void sleep(Duration duration) = 0;
};

/// Where devices are found.
class Bus {
 public:
  Bus() = default;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;
  virtual ~Bus() = default;

  /// Devices of these kinds that are plugged in now.
  virtual std::vector<Address> find(std::span<const Id> ids) = 0;
  /// Must not outlive the bus.
  virtual std::unique_ptr<Handle> open(const Address& address) = 0;
};

/// "0403:6014 at USB port 1-4.2, serial number FT1ABC", for messages.
std::string describe(const Address& address);

}  // namespace imunoise::drivers::usb
