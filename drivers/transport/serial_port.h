#pragma once

// Bytes over a serial line.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "drivers/codec/bytes.h"

namespace imunoise::transport {

/// A serial port in raw mode: 8 bits, no parity, 1 stop bit, no flow control; no other imunoise has
/// it open. Every function may throw plugin::DeviceError: IMUNOISE_DISCONNECTED once the port is
/// gone, after which it can only be closed. One thread at a time.
class SerialPort {
 public:
  /// `path` may be a link, as in /dev/serial/by-id; "pty:PATH" is a pseudo-terminal, which
  /// libserialport does not take. Throws IMUNOISE_NOT_FOUND (naming the ports there are),
  /// IMUNOISE_NO_ACCESS (no permission, or in use).
  static std::unique_ptr<SerialPort> open(const std::string& path);
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;
  virtual ~SerialPort() = default;

  /// False where the port cannot do it. What was received before is dropped.
  [[nodiscard]] virtual bool set_baud(std::uint32_t baud) = 0;
  /// What has come, as much as fits; 0: nothing now.
  virtual std::size_t read(std::span<std::uint8_t> into) = 0;
  /// Writes all of it, or throws.
  virtual void write(drivers::Bytes bytes) = 0;

  /// For poll(2): readable where read() has something, or where the port is gone.
  virtual int descriptor() const = 0;
  const std::string& path() const { return path_; }

 protected:
  explicit SerialPort(std::string path) : path_(std::move(path)) {}
  // From then on it is ours; another program that does the same is refused.
  void lock(int descriptor) const;
  [[noreturn]] void fail(std::int32_t code, const std::string& what) const;
  [[noreturn]] void fail_as_gone() const;

 private:
  std::string path_;
};

/// The port, with everything that is read of it shown to `tap` as well. Where there is no tap it is
/// the port itself.
std::unique_ptr<SerialPort> tapped(std::unique_ptr<SerialPort> port,
                                   std::function<void(drivers::Bytes)> tap);

/// What SerialPort::open() makes of ports with and without a wire behind them.
std::unique_ptr<SerialPort> open_wired_port(const std::string& path);
std::unique_ptr<SerialPort> open_pseudo_terminal(const std::string& path);

}  // namespace imunoise::transport
