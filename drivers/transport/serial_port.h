#pragma once

// Bytes over a serial line, by libserialport.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "drivers/codec/bytes.h"

struct sp_port;

namespace imunoise::transport {

/// A serial port in raw mode: 8 bits, no parity, 1 stop bit, no flow control; no other imunoise has
/// it open. Every function may throw plugin::DeviceError: IMUNOISE_DISCONNECTED once the port is
/// gone, after which it can only be closed. One thread at a time.
class SerialPort {
 public:
  /// `path` may be a link, as in /dev/serial/by-id. Throws IMUNOISE_NOT_FOUND (naming the ports
  /// there are), IMUNOISE_NO_ACCESS (no permission, or in use).
  explicit SerialPort(std::string path);

  /// False where the port cannot do it. What was received before is dropped.
  [[nodiscard]] bool set_baud(std::uint32_t baud);
  /// What has come, as much as fits; 0: nothing now.
  std::size_t read(std::span<std::uint8_t> into);
  /// Writes all of it, or throws.
  void write(drivers::Bytes bytes);

  /// For poll(2): readable where read() has something, or where the port is gone.
  int descriptor() const { return descriptor_; }
  const std::string& path() const { return path_; }

 private:
  struct Closer {
    void operator()(sp_port* port) const;
  };

  void lock() const;
  [[noreturn]] void fail(std::int32_t code, const std::string& what) const;
  [[noreturn]] void fail_as_gone() const;

  std::string path_;
  std::unique_ptr<sp_port, Closer> port_;
  int descriptor_ = -1;
};

}  // namespace imunoise::transport
