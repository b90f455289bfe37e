#pragma once

// An ADIS16405: registers, self-test, data-ready, SPI words. Source: ADIS16400/405 datasheet Rev.
// B. Not emulated: the filters (a source gives what is behind them), alarms, offsets, sleep, the
// auxiliary output.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/support/random.h"
#include "drivers/adis16405/codec/burst.h"
#include "drivers/emulator/measurement/sample_source.h"
#include "drivers/emulator/sensors/history.h"
#include "drivers/emulator/usb/spi_slave.h"

namespace imunoise::emulator {

/// Faults to inject; may be changed between two transfers.
struct SensorFaults {
  double bit_error_rate = 0.0;    ///< Probability that a byte of an answer has one wrong bit.
  std::uint64_t stale_every = 0;  ///< Every so many data-readies announce nothing; 0: none.
  bool stalled = false;           ///< No samples until the next reset.
  bool dead = false;              ///< Drives no line: ones.
  std::uint16_t diagnosis = 0;    ///< Set in DIAG_STAT again and again (EA in every word).
  std::uint16_t self_test = 0;    ///< DIAG_STAT after a self-test.
  std::uint16_t product_id = drivers::adis16405::kProductId;
  bool forgets_writes = false;  ///< Registers keep their values, whatever is written.
};

/// A sample when it was taken.
struct TakenSample {
  Time time{};
  std::array<std::int16_t, drivers::adis16405::kBurstChannels> counts{};
};

/// A burst as its bits were on the wire, with their errors.
struct SentBurst {
  Time time{};  // chip select rose
  std::vector<std::uint8_t> bytes;
};

class Adis16405 final : public SpiSlave {
 public:
  /// Borrows the source. `seed`: of bit errors.
  Adis16405(SampleSource& source, std::uint64_t seed, Memory memory = Memory::kAll);

  SensorFaults faults;

  /// All samples and bursts since construction, where they are kept.
  const std::vector<TakenSample>& taken() const { return taken_.items(); }
  const std::vector<SentBurst>& sent() const { return sent_.items(); }
  /// How many samples there were.
  std::size_t samples() const { return taken_.size(); }
  /// What the bus did against the datasheet: "clock low when selected", ...; each once.
  const std::vector<std::string>& violations() const { return violations_; }

  void power_up() override;
  void select(Time now, bool clock_high) override;
  std::uint8_t exchange(std::uint8_t byte, Time now, Hertz clock) override;
  void deselect(Time now) override;
  bool data_ready(Time now) override;
  Time next_change(Time now) override;

 private:
  using Register = drivers::adis16405::Register;

  std::uint16_t& at(Register address) { return registers_[static_cast<std::size_t>(address) / 2]; }
  void reset(Time ready);
  void update_scales();
  void start_sampling(Time at);
  void catch_up(Time now);
  void take_sample(Time time);
  void end_self_test(Time now);
  bool low_power() { return at(Register::kSamplePeriod) >= 0x0a; }
  Time sample_time(std::uint64_t index);
  std::uint16_t answer_word(Time now);
  std::uint16_t read_register(std::size_t index);
  void execute(std::uint16_t word, Time now);
  void write_byte(std::uint8_t address, std::uint8_t value, Time now);
  std::uint8_t spoil(std::uint8_t byte);
  void expect(bool holds, const char* violation);

  SampleSource& source_;
  RandomStream random_;
  std::array<std::uint16_t, 64> registers_{};
  std::array<drivers::SiUnit, drivers::adis16405::kBurstChannels> scales_;  // as SENS_AVG says

  Time ready_{};            // it hears nothing before
  Time self_test_end_{-1};  // negative: none runs
  Time sampling_since_{};
  std::uint64_t next_ = 1;   // sample since then
  Time last_announced_{-1};  // data-ready rose

  Time deselected_{};
  Time selected_{};
  std::vector<std::uint8_t> heard_;  // bytes of this frame
  std::vector<std::uint8_t> said_;
  std::uint16_t answer_ = 0;  // the word that the next frame begins with

  History<TakenSample> taken_;
  History<SentBurst> sent_;
  std::vector<std::string> violations_;
};

}  // namespace imunoise::emulator
