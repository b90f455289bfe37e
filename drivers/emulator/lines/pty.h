#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "drivers/codec/bytes.h"

namespace imunoise::emulator {

/// A pseudo-terminal as the device end of a serial line; the host opens what `link` points to: a
/// link that leads nowhere is replaced, anything else stays. Closing it is unplugging. Throws
/// std::system_error.
class Pty {
 public:
  explicit Pty(std::filesystem::path link);
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;
  ~Pty();

  /// What the host wrote, as much as fits; 0: nothing within `timeout_ms`.
  std::size_t read(std::span<std::uint8_t> into, int timeout_ms) const;
  /// Writes what the line has room for; the rest is lost, as on a line without a reader.
  void write(drivers::Bytes bytes) const;
  /// Waits until the host has read what was written; five seconds at most.
  void drain() const;
  /// The baud rate that the host has set.
  std::uint32_t host_baud() const;

 private:
  std::filesystem::path link_;
  int device_end_ = -1;
  int host_end_ = -1;  // kept open, so that the line outlives a host that closes it
};

}  // namespace imunoise::emulator
