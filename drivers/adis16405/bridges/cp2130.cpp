#include "drivers/adis16405/bridges/cp2130.h"

#include <cassert>

namespace imunoise::drivers::adis16405 {
namespace {

enum Request : std::uint8_t { kSetChipSelect = 0x25, kSetSpiWord = 0x31, kSetSpiDelay = 0x33 };

constexpr double kFastest = 12e6;  // Hz
constexpr unsigned kSlowestCode = 7;
constexpr std::uint8_t kPushPullMode3 = 1U << 5U | 1U << 4U | 1U << 3U;  // CPHA, CPOL, push-pull
constexpr std::uint8_t kExclusively = 2;
constexpr std::uint8_t kWriteRead = 2;

}  // namespace

Cp2130Request cp2130_spi_word(std::uint8_t channel, Hertz clock) {
  unsigned code = 0;
  while (code < kSlowestCode && kFastest / (1U << code) > clock.value) ++code;
  assert(kFastest / (1U << code) <= clock.value);
  return {kSetSpiWord, {channel, static_cast<std::uint8_t>(kPushPullMode3 | code)}};
}

Cp2130Request cp2130_select_only(std::uint8_t channel) {
  return {kSetChipSelect, {channel, kExclusively}};
}

Cp2130Request cp2130_no_delays(std::uint8_t channel) {
  return {kSetSpiDelay, {channel, 0, 0, 0, 0, 0, 0, 0}};
}

std::vector<std::uint8_t> cp2130_write_read(Bytes send) {
  const auto length = static_cast<std::uint32_t>(send.size());
  std::vector<std::uint8_t> out = {0, 0, kWriteRead, 0};
  for (unsigned shift = 0; shift < 32; shift += 8) {
    out.push_back(static_cast<std::uint8_t>(length >> shift));
  }
  out.insert(out.end(), send.begin(), send.end());
  return out;
}

}  // namespace imunoise::drivers::adis16405
