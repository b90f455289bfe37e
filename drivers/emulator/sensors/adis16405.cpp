#include "drivers/emulator/sensors/adis16405.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace imunoise::emulator {
namespace {

using namespace drivers::adis16405;
using namespace std::chrono_literals;

constexpr Time kPowerUpTime = 220ms;
constexpr Time kResetTime = 100ms;
constexpr Time kSelfTestTime = 12ms;
constexpr Time kPulse = 150us;  // of data-ready
constexpr Time kStall = 9us;    // between frames
constexpr Time kStallLowPower = 75us;
constexpr std::uint16_t kNew = 0x8000;
constexpr std::uint16_t kAlarm = 0x4000;
constexpr std::size_t kFirstOutput = static_cast<std::size_t>(Register::kSupply) / 2;
constexpr std::uint8_t kFirstWritable = 0x1a;  // below are the outputs
constexpr double kSlack = 1.0 + 1e-9;          // clocks are fractions of 60 MHz

std::array<double, kBurstChannels> in_order(const Measurement& m) {
  return {m.supply,
          m.rate[0],
          m.rate[1],
          m.rate[2],
          m.specific_force[0],
          m.specific_force[1],
          m.specific_force[2],
          m.field[0],
          m.field[1],
          m.field[2],
          m.temperature,
          m.auxiliary};
}

std::int16_t quantise(double value, const drivers::SiUnit& scale) {
  const double counts = (value - scale.offset) / scale.scale;
  return static_cast<std::int16_t>(std::lround(std::clamp(counts, -32768.0, 32767.0)));
}

}  // namespace

Adis16405::Adis16405(SampleSource& source, std::uint64_t seed, Memory memory)
    : source_(source), random_(seed), taken_(memory), sent_(memory) {
  power_up();
}

void Adis16405::power_up() {
  deselected_ = selected_ = Time(0);
  heard_.clear();
  said_.clear();
  reset(kPowerUpTime);
}

void Adis16405::reset(Time ready) {
  faults.stalled = false;
  registers_.fill(0);
  at(Register::kMiscControl) = kDefaultMiscControl;
  at(Register::kSamplePeriod) = kDefaultSamplePeriod;
  at(Register::kSensitivityAveraging) = kDefaultSensitivityAveraging;
  at(Register::kProductId) = faults.product_id;
  update_scales();
  ready_ = ready;
  self_test_end_ = Time(-1);
  start_sampling(ready_);
}

// A range that there is not leaves things as they are.
void Adis16405::update_scales() {
  if (const auto scales = count_scales(at(Register::kSensitivityAveraging))) {
    scales_ = si_scales(*scales);
  }
}

void Adis16405::start_sampling(Time at) {
  sampling_since_ = at;
  next_ = 1;
  last_announced_ = Time(-1);
}

Time Adis16405::sample_time(std::uint64_t index) {
  const double period = 1e9 / sample_rate(at(Register::kSamplePeriod)).value;
  return sampling_since_ + Time(std::llround(static_cast<double>(index) * period));
}

// All that happens by itself up to `now`.
void Adis16405::catch_up(Time now) {
  if (self_test_end_ >= Time(0)) end_self_test(now);
  if (self_test_end_ >= Time(0)) return;
  for (; sample_time(next_) <= now; ++next_) {
    if (!faults.stalled) take_sample(sample_time(next_));
  }
}

void Adis16405::end_self_test(Time now) {
  if (now < self_test_end_) return;
  at(Register::kMiscControl) &= static_cast<std::uint16_t>(~kMiscSelfTest);
  at(Register::kDiagnosticStatus) |= faults.self_test;
  start_sampling(self_test_end_);
  self_test_end_ = Time(-1);
}

void Adis16405::take_sample(Time time) {
  last_announced_ = time;
  if (faults.stale_every != 0 && next_ % faults.stale_every == 0) return;
  Burst burst;
  const auto values = in_order(source_.measure(std::chrono::duration<double>(time).count()));
  for (std::size_t i = 0; i < kBurstChannels; ++i) {
    burst.counts[i] = quantise(values[i], scales_[i]);
  }
  burst.is_new = 0x0fff;
  const std::vector<std::uint8_t> bytes = encode_burst(burst);  // counts end with their 14 bits
  drivers::BigEndianReader words(bytes);
  words.take<std::uint16_t>();
  for (std::size_t i = 0; i < kBurstChannels; ++i) {
    registers_[kFirstOutput + i] = words.take<std::uint16_t>();
  }
  taken_.push_back({time, parse_burst(bytes)->counts});
  at(Register::kDiagnosticStatus) |= faults.diagnosis;
}

bool Adis16405::data_ready(Time now) {
  catch_up(now);
  const bool enabled = (at(Register::kMiscControl) & kMiscDataReady) != 0;
  const bool high = last_announced_ >= Time(0) && now < last_announced_ + kPulse;
  return enabled && high && !faults.dead;
}

Time Adis16405::next_change(Time now) {
  const bool enabled = (at(Register::kMiscControl) & kMiscDataReady) != 0;
  if (data_ready(now)) return last_announced_ + kPulse;
  if (!enabled || faults.stalled || faults.dead || self_test_end_ >= Time(0)) return Time::max();
  return sample_time(next_);
}

void Adis16405::select(Time now, bool clock_high) {
  catch_up(now);
  expect(clock_high, "clock low when selected: not SPI mode 3");
  if (deselected_ > Time(0)) {
    expect(now - deselected_ >= (low_power() ? kStallLowPower : kStall),
           "selected again before the stall time was over");
  }
  selected_ = now;
  heard_.clear();
  said_.clear();
}

std::uint8_t Adis16405::exchange(std::uint8_t byte, Time now, Hertz clock) {
  catch_up(now);
  const bool upper = heard_.size() % 2 == 0;
  const Hertz fastest = fastest_spi_clock(at(Register::kSamplePeriod));
  expect(clock.value <= fastest.value * kSlack, "SPI clock too fast");
  if (heard_.size() == 2) expect(clock.value <= kBurstClock.value * kSlack, "burst too fast");
  if (upper) answer_ = answer_word(now);
  heard_.push_back(byte);
  said_.push_back(spoil(static_cast<std::uint8_t>(upper ? answer_ >> 8U : answer_ & 0xffU)));
  return said_.back();
}

// The word that goes out next: in a burst each output in its turn, else the answer of the frame
// before.
std::uint16_t Adis16405::answer_word(Time now) {
  if (faults.dead) return 0xffff;
  if (now < ready_) return 0;
  const std::size_t word = heard_.size() / 2;
  const bool burst = word > 0 && heard_[0] == kBurstRequest[0] && heard_[1] == 0;
  return burst && word <= kBurstChannels ? read_register(kFirstOutput + word - 1) : answer_;
}

std::uint16_t Adis16405::read_register(std::size_t index) {
  std::uint16_t& stored = registers_[index];
  const std::uint16_t out = stored;
  const bool output = index >= kFirstOutput && index < kFirstOutput + kBurstChannels;
  if (output) {
    stored &= static_cast<std::uint16_t>(~kNew);
    const bool alarm = at(Register::kDiagnosticStatus) != 0;
    return alarm ? out | kAlarm : out;
  }
  if (&stored == &at(Register::kDiagnosticStatus)) stored = 0;
  return out;
}

void Adis16405::deselect(Time now) {
  catch_up(now);
  deselected_ = now;
  if (heard_.size() == kBurstBytes) {
    sent_.push_back({now, said_});
  } else if (heard_.size() == 2 && now >= ready_) {
    execute(static_cast<std::uint16_t>(heard_[0] << 8U | heard_[1]), now);
  } else {
    expect(now < ready_, "a frame that is neither a word nor a burst");
  }
}

void Adis16405::execute(std::uint16_t word, Time now) {
  const auto address = static_cast<std::uint8_t>(word >> 8U & 0x7fU);
  if ((word & 0x8000U) != 0) {
    write_byte(address, static_cast<std::uint8_t>(word & 0xffU), now);
  } else {
    answer_ = read_register(address / 2U);
  }
}

void Adis16405::write_byte(std::uint8_t address, std::uint8_t value, Time now) {
  if (address < kFirstWritable || faults.forgets_writes) return;
  std::uint16_t& stored = registers_[address / 2U];
  const unsigned kept = stored;
  const unsigned written = value;
  stored = static_cast<std::uint16_t>(address % 2 != 0 ? (kept & 0x00ffU) | written << 8U
                                                       : (kept & 0xff00U) | written);
  if (&stored == &at(Register::kGlobalCommand)) {
    const bool resets = (stored & kCommandSoftwareReset) != 0;
    stored = 0;
    if (resets) reset(now + kResetTime);
  } else if (&stored == &at(Register::kSensitivityAveraging)) {
    update_scales();
  } else if (&stored == &at(Register::kSamplePeriod)) {
    start_sampling(now);
  } else if (&stored == &at(Register::kMiscControl) && (stored & kMiscSelfTest) != 0) {
    self_test_end_ = now + kSelfTestTime;
  }
}

std::uint8_t Adis16405::spoil(std::uint8_t byte) {
  if (faults.bit_error_rate == 0.0 ||
      !std::bernoulli_distribution(faults.bit_error_rate)(random_.engine())) {
    return byte;
  }
  const int bit = std::uniform_int_distribution(0, 7)(random_.engine());
  return static_cast<std::uint8_t>(byte ^ 1U << static_cast<unsigned>(bit));
}

void Adis16405::expect(bool holds, const char* violation) {
  if (holds || std::find(violations_.begin(), violations_.end(), violation) != violations_.end()) {
    return;
  }
  violations_.emplace_back(violation);
}

}  // namespace imunoise::emulator
