#pragma once

// Where bytes of text come from.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "drivers/plugin/wait.h"

namespace imunoise::text {

/// An open source. Every function may throw plugin::DeviceError: IMUNOISE_DISCONNECTED once it is
/// gone, after which it can only be destroyed.
class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;

  /// For poll(2): readable where read() has something.
  virtual int descriptor() const = 0;
  /// What has come, as much as fits; 0: nothing now; empty: it ended in good order.
  virtual std::optional<std::size_t> read(std::span<std::uint8_t> into) = 0;
};

/// How to open a source, and again once it was gone.
struct SourcePlace {
  std::string name;     ///< for messages: "/dev/ttyACM0"
  bool midway = false;  ///< its first bytes may be the end of a line that began earlier
  /// Throws plugin::DeviceError; waits at most as long as `wait` says.
  std::function<std::unique_ptr<Source>(const plugin::Wait& wait)> open;
};

/// A serial port at so many baud.
SourcePlace serial_source(const std::string& path, std::uint32_t baud);
/// A named pipe, a file, or a character device.
SourcePlace file_source(const std::string& path);
/// A TCP port, "HOST:PORT", IPv6 as "[ADDRESS]:PORT". Error: another form (IMUNOISE_BAD_OPTION).
SourcePlace tcp_source(const std::string& address);
/// What a command of the shell prints. It is ended with the source.
SourcePlace command_source(const std::string& command);

}  // namespace imunoise::text
