#include "drivers/emulator/usb/ft232h.h"

#include <algorithm>

#include "drivers/adis16405/bridges/mpsse.h"

namespace imunoise::emulator {
namespace {

using namespace std::chrono_literals;
using drivers::adis16405::kFtdiPacketBytes;
using drivers::adis16405::kFtdiStatusBytes;

constexpr std::size_t kPayload = kFtdiPacketBytes - kFtdiStatusBytes;
constexpr Time kDefaultLatency = 16ms;
constexpr std::uint16_t kInterfaceA = 1;

}  // namespace

Ft232h::Ft232h(SpiSlave& sensor, std::string serial)
    : sensor_(sensor), identity_{{0x0403, 0x6014}, std::move(serial)}, engine_(sensor) {
  power_up();
}

void Ft232h::power_up() {
  engine_.reset();
  mpsse_ = false;
  latency_ = kDefaultLatency;
  now_ = last_packet_ = Time(0);
  sensor_.power_up();
}

bool Ft232h::control(const drivers::usb::Request& request) {
  if (request.index != kInterfaceA) return false;
  switch (request.request) {
    case 0x00:  // reset: 0 all, 1 what was received, 2 what is to be sent (seen from the host)
      if (request.value != 2) engine_.drop_answers();
      if (request.value != 1) engine_.drop_commands();
      return request.value <= 2;
    case 0x09:
      latency_ = std::chrono::milliseconds(request.value);
      return request.value >= 1 && request.value <= 255;
    case 0x0b:
      mpsse_ = request.value >> 8U == 2;
      if (!mpsse_) engine_.reset();
      return true;
    default:
      return false;
  }
}

// Outside MPSSE mode, bytes go to a serial line without a receiver.
std::size_t Ft232h::out(drivers::Bytes bytes) {
  return mpsse_ ? engine_.accept(bytes) : bytes.size();
}

bool Ft232h::packet_ready() const {
  return engine_.flushed() || engine_.answers() >= kPayload || now_ >= last_packet_ + latency_;
}

std::optional<std::vector<std::uint8_t>> Ft232h::in() {
  if (!packet_ready()) return std::nullopt;
  last_packet_ = now_;
  std::vector<std::uint8_t> out = {0x32, 0x60};  // modem and line status
  const std::vector<std::uint8_t> answers = engine_.take(kPayload);
  out.insert(out.end(), answers.begin(), answers.end());
  return out;
}

void Ft232h::run(Time until) {
  const Time timer = last_packet_ + latency_;
  now_ = engine_.work(now_, now_ < timer ? std::min(timer, until) : until);
}

}  // namespace imunoise::emulator
