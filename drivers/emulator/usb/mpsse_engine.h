#pragma once

// The MPSSE engine of an FT232H, as far as SPI needs it. Sources: pyftdi, flashrom, libmpsse.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "drivers/codec/bytes.h"
#include "drivers/emulator/usb/spi_slave.h"

namespace imunoise::emulator {

/// Runs commands in order; each takes the time it takes. Commands and answers wait in queues of
/// 1 KiB, as in the chip: a full queue blocks its writer.
class MpsseEngine {
 public:
  /// Borrows the sensor, which hangs on SK, DO, DI, CS and, with data-ready, on GPIOL1.
  explicit MpsseEngine(SpiSlave& sensor) : sensor_(sensor) {}

  /// Off and on again: nothing queued, lines at rest.
  void reset();
  /// Takes commands as far as there is room; returns how many bytes.
  std::size_t accept(drivers::Bytes commands);
  /// Runs one command, or waits until `until` where it cannot. Returns where time stands.
  Time work(Time now, Time until);
  /// Takes answers, at most so many bytes.
  std::vector<std::uint8_t> take(std::size_t most);
  std::size_t answers() const { return answers_.size(); }
  /// Answers should go out though they fill no packet.
  bool flushed() const { return flushed_; }

  void drop_commands() { commands_.clear(); }
  void drop_answers();

 private:
  static constexpr std::uint8_t kIdlePins = 0x09;  // clock and chip select high

  // False: it cannot run yet.
  bool run_command(Time& now, Time until);
  void run_short(std::uint8_t opcode, Time& now);
  bool transfer(Time& now);
  bool await_level(bool level, Time& now, Time until);
  void set_pins(std::uint8_t pins, Time now);
  std::uint8_t pop();

  SpiSlave& sensor_;
  std::deque<std::uint8_t> commands_;
  std::deque<std::uint8_t> answers_;
  bool flushed_ = false;
  Hertz clock_{6e6};
  std::uint8_t pins_ = kIdlePins;
};

}  // namespace imunoise::emulator
