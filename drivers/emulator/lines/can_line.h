#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drivers/can/codec/frame.h"

namespace imunoise::emulator {

/// Where an emulated CAN device puts its frames.
class CanLine {
 public:
  CanLine() = default;
  CanLine(const CanLine&) = delete;
  CanLine& operator=(const CanLine&) = delete;
  virtual ~CanLine() = default;

  /// False where the line is down, and the frame lost.
  virtual bool send(const drivers::CanFrame& frame) = 0;
};

/// A CAN interface of Linux, best a virtual one: ip link add dev vcan0 type vcan. Throws
/// std::system_error where there is none.
class SocketCanLine final : public CanLine {
 public:
  explicit SocketCanLine(const std::string& interface);
  ~SocketCanLine() override;

  bool send(const drivers::CanFrame& frame) override;

 private:
  int descriptor_ = -1;
};

/// A bus without a kernel that has CAN: the driver `can` listens at interface=unix:PATH. Sockets of
/// type SOCK_SEQPACKET, a frame of Linux a packet. Throws std::system_error.
class LocalCanLine final : public CanLine {
 public:
  /// Makes the socket; `path` must be free, or a socket without a server.
  explicit LocalCanLine(std::filesystem::path path);
  ~LocalCanLine() override;

  bool send(const drivers::CanFrame& frame) override;

 private:
  void accept_listeners();

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::vector<int> listeners_;
};

}  // namespace imunoise::emulator
