#pragma once

// SocketCAN without a kernel that has it: the program that links fake_can_bus.cpp gets CAN sockets
// that are socket pairs. Filters, time stamps, counts of lost frames, links that go down and
// adapters that are unplugged behave as the kernel's do; everything else is the kernel's.

#include <cstdint>
#include <string>

#include "drivers/emulator/lines/can_line.h"

namespace imunoise::testing {

/// A CAN interface that is up. One at a time.
class FakeCanBus final : public emulator::CanLine {
 public:
  explicit FakeCanBus(const std::string& name);
  ~FakeCanBus() override;

  /// Delivers a frame to every socket whose filter lets it pass. Thread-safe.
  bool send(const drivers::CanFrame& frame) override;
  /// The sockets' queues had no room for so many frames.
  void lose(std::uint32_t frames);
  void set_up(bool up);
  void unplug();
  void plug_in();
};

}  // namespace imunoise::testing
