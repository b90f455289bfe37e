#pragma once

// Frames of a CAN interface of Linux (SocketCAN).

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "drivers/can/codec/frame.h"

namespace imunoise::transport {

/// Frames that are wanted: those of exactly this identifier.
struct CanFilter {
  std::uint32_t id = 0;
  bool extended = false;
};

struct ReceivedCanFrame {
  drivers::CanFrame frame;
  std::int64_t time_ns = 0;  ///< When the kernel received it, ns since 1970-01-01 UTC.
  std::uint32_t lost = 0;    ///< Frames that the socket's queue had no room for since the last one.
};

/// Receives frames of CAN and CAN FD that pass a filter, and all error frames. Functions throw
/// plugin::DeviceError: IMUNOISE_DISCONNECTED once the interface is down or gone, after which it
/// can only be closed. One thread at a time.
class CanSocket {
 public:
  /// "unix:PATH" is an emulated bus instead, which passes every frame. Throws IMUNOISE_NOT_FOUND
  /// (no such interface, it is down, the kernel has no CAN) and IMUNOISE_NO_ACCESS.
  CanSocket(std::string interface, std::span<const CanFilter> filters);
  CanSocket(const CanSocket&) = delete;
  CanSocket& operator=(const CanSocket&) = delete;
  ~CanSocket();

  /// The next frame; nothing when none waits.
  std::optional<ReceivedCanFrame> receive();
  /// For poll(2).
  int descriptor() const { return descriptor_; }

 private:
  [[noreturn]] void fail(std::int32_t code, const std::string& what);
  void connect_to_emulator(const std::string& path);
  void stamp_times();
  void bind_to_interface();
  void configure(std::span<const CanFilter> filters);
  template <class Value>
  void set(int level, int option, const Value& value);

  std::string interface_;
  int descriptor_ = -1;
  std::uint32_t dropped_ = 0;  // as the kernel counts
};

}  // namespace imunoise::transport
