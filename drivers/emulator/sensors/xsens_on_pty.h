#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "drivers/emulator/faults/fault.h"
#include "drivers/emulator/lines/pty.h"
#include "drivers/emulator/sensors/history.h"
#include "drivers/emulator/sensors/xsens_mti.h"

namespace imunoise::emulator {

/// A message, and whether the line carried it whole.
struct SentMessage {
  MtiMessage message;
  bool intact = true;
};

/// An MTi on a pseudo-terminal, in real time, in a thread of its own. Where host and device differ
/// in their baud rates, only noise passes. Faults count the samples of sent().
class XsensOnPty {
 public:
  /// Borrows the source, which its thread calls.
  XsensOnPty(MtiOptions options, SampleSource& source, std::vector<Fault> faults,
             std::filesystem::path link, Memory memory = Memory::kAll);
  ~XsensOnPty() = default;

  /// Everything measured so far since the host said GoToMeasurement, where it is kept. Thread-safe.
  std::vector<SentMessage> sent() const;
  /// How many messages that were. Thread-safe.
  std::size_t messages() const;
  /// How often the host wrote the device's configuration. Thread-safe.
  std::uint64_t writes() const;

 private:
  using Clock = std::chrono::steady_clock;

  void run(const std::stop_token& stop);
  void talk_until(Clock::time_point moment);
  void send_sample();
  bool pass(const Fault& fault, std::vector<std::uint8_t>& frame);
  void write(drivers::Bytes bytes) const;

  std::filesystem::path link_;
  FaultPlan faults_;
  mutable std::mutex mutex_;  // of device_ and sent_
  XsensMti device_;
  History<SentMessage> sent_;
  std::unique_ptr<Pty> line_;        // none while unplugged
  std::uint64_t unplugged_for_ = 0;  // samples more
  std::vector<std::uint8_t> held_back_;
  Clock::time_point due_;
  std::jthread thread_;
};

}  // namespace imunoise::emulator
