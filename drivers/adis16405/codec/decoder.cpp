#include "drivers/adis16405/codec/decoder.h"

#include <cmath>

namespace imunoise::drivers::adis16405 {
namespace {

constexpr std::array<std::string_view, kBurstChannels> kOldFlags = {
    "old_supply",      "",           "", "", "", "", "", "old_mag_x", "old_mag_y", "old_mag_z",
    "old_temperature", "old_aux_adc"};

}  // namespace

BurstDecoder::BurstDecoder(const std::array<CountScale, kBurstChannels>& scales, Hertz rate)
    : rate_(rate), units_(si_scales(scales)) {}

bool BurstDecoder::next(DecodedSample& sample) {
  bool found = false;
  while (!found) {
    const auto bytes = bursts_.next();
    if (!bytes) break;
    const auto burst = decode_burst(*bytes);
    found = burst.has_value();
    if (found) {
      fill(*burst, sample);
    } else {
      own_.add(burst.error());
    }
  }
  tally_.refused = bursts_.refused();
  tally_.refused += own_;
  return found;
}

void BurstDecoder::fill(const Burst& burst, DecodedSample& sample) {
  sample.clear();
  sample.stream = "imu";
  sample.clock = Clock::kNominal;
  sample.time_ns = std::llround(static_cast<double>(tally_.samples) / rate_.value * 1e9);
  for (std::size_t i = 0; i < kBurstChannels; ++i) {
    append_value(sample, kChannelNames[i], units_[i], burst.counts[i], own_);
    if ((burst.is_new >> i & 1U) == 0) sample.flags.push_back(kOldFlags[i]);
  }
  if (burst.alarm != 0) sample.flags.push_back("error_alarm");
  ++tally_.samples;
}

}  // namespace imunoise::drivers::adis16405
