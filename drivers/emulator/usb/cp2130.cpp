#include "drivers/emulator/usb/cp2130.h"

#include <algorithm>
#include <utility>

namespace imunoise::emulator {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kUsbQueue = 128;  // bytes of commands: two packets
constexpr std::size_t kHeader = 8;      // 0 0 command 0, length with its lowest byte first
constexpr Time kTransferTime = 200us;   // of the way through full-speed USB (an estimate)

}  // namespace

Cp2130::Cp2130(SpiSlave& sensor, std::string serial)
    : sensor_(sensor), identity_{{0x10c4, 0x87a0}, std::move(serial), 0x82, 0x01, 64} {
  power_up();
}

void Cp2130::power_up() {
  mode3_ = selects_ = false;
  commands_.clear();
  answers_.clear();
  now_ = Time(0);
  sensor_.power_up();
}

bool Cp2130::control(const drivers::usb::Request& request) {
  const std::vector<std::uint8_t>& data = request.data;
  if (!commands_.empty()) return false;  // the chip hangs if it is disturbed
  if (request.request == 0x25 && data.size() == 2) {
    selects_ = data[0] == 0 && data[1] == 2;
    return true;
  }
  if (request.request == 0x31 && data.size() == 2) {
    mode3_ = (data[1] & 0x30U) == 0x30U;
    clock_ = {12e6 / (1U << (data[1] & 7U))};
    return true;
  }
  return request.request == 0x33 && data.size() == 8;
}

std::size_t Cp2130::out(drivers::Bytes bytes) {
  const std::size_t count = std::min(bytes.size(), kUsbQueue - commands_.size());
  commands_.insert(commands_.end(), bytes.begin(),
                   bytes.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

std::optional<std::vector<std::uint8_t>> Cp2130::in() {
  if (answers_.empty()) return std::nullopt;
  return std::exchange(answers_, {});
}

void Cp2130::run(Time until) {
  if (!answers_.empty() || !transfer()) now_ = std::max(now_, until);
}

// Runs the first command if it is there as a whole.
bool Cp2130::transfer() {
  if (commands_.size() < kHeader) return false;
  const std::size_t length = commands_[4] + 256U * commands_[5];
  if (commands_.size() < kHeader + length) return false;
  const bool both_ways = commands_[2] == 2;
  commands_.erase(commands_.begin(), commands_.begin() + kHeader);
  now_ += kTransferTime;
  const bool heard = both_ways && selects_;
  if (heard) sensor_.select(now_, mode3_);
  for (std::size_t i = 0; i < length; ++i) {
    answers_.push_back(heard ? sensor_.exchange(commands_.front(), now_, clock_)
                             : std::uint8_t{0xff});
    commands_.pop_front();
    now_ += Time(static_cast<Time::rep>(8e9 / clock_.value));
  }
  if (heard) sensor_.deselect(now_);
  return true;
}

}  // namespace imunoise::emulator
