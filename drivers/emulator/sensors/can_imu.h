#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/can/codec/channels.h"
#include "drivers/emulator/faults/fault.h"
#include "drivers/emulator/lines/can_line.h"
#include "drivers/emulator/measurement/sample_source.h"
#include "drivers/emulator/sensors/history.h"

namespace imunoise::emulator {

/// A frame as it was meant, and whether it got onto the bus.
struct SentCanFrame {
  std::string message;
  std::uint64_t sample = 0;
  std::vector<std::pair<std::string, double>> values;  ///< By channel, in the database's units.
  bool sent = true;
};

/// An IMU that sends the messages of a database, one of each a sample, in real time, from a thread
/// of its own. Channels show what value_of() knows; "counter" counts samples, "sample_time" is in
/// ticks of 100 µs, others are 0. What a signal cannot hold saturates. Signals that a multiplexor
/// switches are not sent.
class CanImu {
 public:
  /// Borrows source and line, which its thread calls.
  CanImu(drivers::CanChannels channels, double rate_hz, SampleSource& source, CanLine& line,
         std::vector<Fault> faults = {}, Memory memory = Memory::kAll);

  /// Everything so far, where it is kept. Thread-safe.
  std::vector<SentCanFrame> sent() const;
  /// How many frames that were. Thread-safe.
  std::size_t frames() const;

 private:
  struct Composed {
    SentCanFrame record;
    drivers::CanFrame frame;
  };

  void run(const std::stop_token& stop);
  void send_sample(std::uint64_t sample);
  std::vector<Composed> compose(std::uint64_t sample);
  double value(const drivers::ChannelMapping& mapping, const drivers::CanSignal& signal,
               const Measurement& measurement, std::uint64_t sample) const;
  void report_error(std::uint32_t kind);
  void put_on_bus(Composed composed);

  drivers::CanChannels channels_;
  double rate_hz_;
  SampleSource& source_;
  CanLine& line_;
  FaultPlan faults_;
  std::vector<Composed> held_back_;
  std::uint64_t bus_off_until_ = 0;  // sample
  mutable std::mutex mutex_;         // of sent_
  History<SentCanFrame> sent_;
  std::jthread thread_;
};

}  // namespace imunoise::emulator
