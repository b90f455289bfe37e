#include "drivers/emulator/usb/mpsse_engine.h"

#include <algorithm>

namespace imunoise::emulator {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kQueue = 1024;  // bytes each way
constexpr double kEngineClock = 60e6;
constexpr Time kCommandTime = 100ns;
constexpr std::uint8_t kClockPin = 0x01;
constexpr std::uint8_t kSelectPin = 0x08;
constexpr std::uint8_t kDataReadyPin = 0x20;
constexpr std::uint8_t kPulledUp = 0xd4;  // DI and the other GPIOL pins

Time cycles(double count, Hertz clock) {
  return Time(static_cast<Time::rep>(count / clock.value * 1e9));
}

}  // namespace

std::size_t MpsseEngine::accept(drivers::Bytes commands) {
  const std::size_t count = std::min(commands.size(), kQueue - commands_.size());
  commands_.insert(commands_.end(), commands.begin(),
                   commands.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

std::vector<std::uint8_t> MpsseEngine::take(std::size_t most) {
  const auto end = answers_.begin() + static_cast<std::ptrdiff_t>(std::min(most, answers_.size()));
  std::vector<std::uint8_t> out(answers_.begin(), end);
  answers_.erase(answers_.begin(), end);
  flushed_ = flushed_ && !answers_.empty();
  return out;
}

void MpsseEngine::drop_answers() {
  answers_.clear();
  flushed_ = false;
}

void MpsseEngine::reset() {
  drop_commands();
  drop_answers();
  pins_ = kIdlePins;
}

Time MpsseEngine::work(Time now, Time until) {
  return run_command(now, until) ? now : std::max(now, until);
}

std::uint8_t MpsseEngine::pop() {
  const std::uint8_t out = commands_.front();
  commands_.pop_front();
  return out;
}

bool MpsseEngine::run_command(Time& now, Time until) {
  if (commands_.empty()) return false;
  const std::uint8_t opcode = commands_.front();
  switch (opcode) {
    case 0x31:  // bytes out on falling, in on rising edges
      return transfer(now);
    case 0x88:
    case 0x89:
      return await_level(opcode == 0x88, now, until);
    case 0x80:
    case 0x86:
    case 0x8f:
      if (commands_.size() < 3) return false;
      break;
    default:
      break;
  }
  pop();
  now += kCommandTime;
  run_short(opcode, now);
  return true;
}

void MpsseEngine::run_short(std::uint8_t opcode, Time& now) {
  const auto pop_number = [&] {
    const unsigned low = pop();
    return low | static_cast<unsigned>(pop()) << 8U;
  };
  switch (opcode) {
    case 0x80:  // levels of the pins, and which are outputs
      set_pins(pop(), now);
      pop();
      break;
    case 0x81:  // levels of the pins; undriven pins are pulled up
      answers_.push_back(static_cast<std::uint8_t>(kPulledUp | pins_ |
                                                   (sensor_.data_ready(now) ? kDataReadyPin : 0U)));
      break;
    case 0x86:
      clock_ = {kEngineClock / (2.0 * (pop_number() + 1.0))};
      break;
    case 0x8f:  // clock without data
      now += cycles(8.0 * (pop_number() + 1.0), clock_);
      break;
    case 0x87:
      flushed_ = !answers_.empty();
      break;
    case 0x85:  // loopback, base clock, three-phase and adaptive clock: as the engine is anyway
    case 0x8a:
    case 0x8d:
    case 0x97:
      break;
    default:
      answers_.insert(answers_.end(), {0xfa, opcode});
      flushed_ = true;
  }
}

bool MpsseEngine::transfer(Time& now) {
  if (commands_.size() < 3) return false;
  const std::size_t length = commands_[1] + 256U * commands_[2] + 1U;
  if (commands_.size() < 3 + length) return false;
  if (answers_.size() + length > kQueue) return false;
  for (int i = 0; i < 3; ++i) pop();
  for (std::size_t i = 0; i < length; ++i) {
    const std::uint8_t byte = pop();
    // With the clock high the engine's first edge would be none: the sensor hears nothing.
    const bool heard = (pins_ & (kClockPin | kSelectPin)) == 0;
    answers_.push_back(heard ? sensor_.exchange(byte, now, clock_) : std::uint8_t{0xff});
    now += cycles(8.0, clock_);
  }
  return true;
}

bool MpsseEngine::await_level(bool level, Time& now, Time until) {
  while (sensor_.data_ready(now) != level) {
    const Time change = sensor_.next_change(now);
    if (change > until) return false;
    now = change;
  }
  pop();
  now += kCommandTime;
  return true;
}

void MpsseEngine::set_pins(std::uint8_t pins, Time now) {
  const bool was_selected = (pins_ & kSelectPin) == 0;
  const bool selected = (pins & kSelectPin) == 0;
  pins_ = pins;
  if (selected && !was_selected) sensor_.select(now, (pins & kClockPin) != 0);
  if (!selected && was_selected) sensor_.deselect(now);
}

}  // namespace imunoise::emulator
