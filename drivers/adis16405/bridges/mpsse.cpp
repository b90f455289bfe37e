#include "drivers/adis16405/bridges/mpsse.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace imunoise::drivers::adis16405 {
namespace {

enum Opcode : std::uint8_t {
  kSetLowPins = 0x80,
  kReadLowPins = 0x81,
  kTransferFallingWriteRisingRead = 0x31,
  kLoopbackOff = 0x85,
  kSetDivisor = 0x86,
  kSendImmediate = 0x87,
  kWaitHigh = 0x88,
  kWaitLow = 0x89,
  kClock60MHz = 0x8a,
  kThreePhaseOff = 0x8d,
  kClockOnly = 0x8f,  // 8 (1 + length) cycles without data
  kAdaptiveOff = 0x97,
};

enum Pin : std::uint8_t { kSk = 0x01, kDo = 0x02, kCs = 0x08 };
constexpr std::uint8_t kOutputs = kSk | kDo | kCs;
constexpr double kEngineClock = 60e6;  // Hz; SK = kEngineClock / (2 (1 + divisor))

void set_pins(std::vector<std::uint8_t>& out, unsigned high) {
  out.insert(out.end(), {kSetLowPins, static_cast<std::uint8_t>(high), kOutputs});
}

}  // namespace

std::vector<std::uint8_t> mpsse_setup(Hertz clock) {
  const double divisor = std::ceil(kEngineClock / (2.0 * clock.value)) - 1.0;
  assert(divisor >= 0.0 && divisor <= 65535.0);
  const auto whole = static_cast<unsigned>(divisor);
  std::vector<std::uint8_t> out = {kClock60MHz,
                                   kAdaptiveOff,
                                   kThreePhaseOff,
                                   kLoopbackOff,
                                   kSetDivisor,
                                   static_cast<std::uint8_t>(whole & 0xffU),
                                   static_cast<std::uint8_t>(whole >> 8U)};
  set_pins(out, kSk | kCs);
  return out;
}

void append_mpsse_transfer(std::vector<std::uint8_t>& out, Bytes send, bool on_data_ready) {
  assert(!send.empty() && send.size() <= 65536);
  if (on_data_ready) out.insert(out.end(), {kWaitLow, kWaitHigh});
  set_pins(out, kSk);
  set_pins(out, 0);
  const std::size_t length = send.size() - 1;
  out.insert(out.end(), {kTransferFallingWriteRisingRead, static_cast<std::uint8_t>(length & 0xffU),
                         static_cast<std::uint8_t>(length >> 8U)});
  out.insert(out.end(), send.begin(), send.end());
  set_pins(out, kCs);
  set_pins(out, kSk | kCs);
}

void append_mpsse_mark(std::vector<std::uint8_t>& out) { out.push_back(kReadLowPins); }

bool is_mpsse_mark(std::uint8_t byte) { return (byte & kOutputs) == (kSk | kCs); }

void append_mpsse_flush(std::vector<std::uint8_t>& out) { out.push_back(kSendImmediate); }

void append_mpsse_pause(std::vector<std::uint8_t>& out, std::chrono::microseconds least,
                        Hertz clock) {
  const double cycles = static_cast<double>(least.count()) * 1e-6 * clock.value;
  const auto eights = static_cast<unsigned>(std::clamp(std::ceil(cycles / 8.0), 1.0, 65536.0)) - 1;
  out.insert(out.end(), {kClockOnly, static_cast<std::uint8_t>(eights & 0xffU),
                         static_cast<std::uint8_t>(eights >> 8U)});
  set_pins(out, kSk | kCs);
}

void strip_ftdi_status(Bytes transfer, std::vector<std::uint8_t>& out) {
  while (!transfer.empty()) {
    const Bytes packet = transfer.first(std::min(transfer.size(), kFtdiPacketBytes));
    if (packet.size() > kFtdiStatusBytes) {
      out.insert(out.end(), packet.begin() + kFtdiStatusBytes, packet.end());
    }
    transfer = transfer.subspan(packet.size());
  }
}

}  // namespace imunoise::drivers::adis16405
