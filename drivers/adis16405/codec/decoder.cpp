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

void BurstDecoder::push(Bytes bytes) {
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
  begin_ = 0;
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

bool BurstDecoder::next(DecodedSample& sample) {
  while (buffer_.size() - begin_ >= kBurstBytes) {
    const auto burst = decode_burst(Bytes(buffer_).subspan(begin_, kBurstBytes));
    begin_ += kBurstBytes;
    if (burst) {
      fill(*burst, sample);
      return true;
    }
    tally_.refused.add(burst.error());
  }
  if (finished_ && begin_ < buffer_.size()) {
    tally_.refused.add(Refusal::kTruncated);
    begin_ = buffer_.size();
  }
  return false;
}

void BurstDecoder::fill(const Burst& burst, DecodedSample& sample) {
  sample.clear();
  sample.stream = "imu";
  sample.clock = Clock::kNominal;
  sample.time_ns = std::llround(static_cast<double>(tally_.samples) / rate_.value * 1e9);
  for (std::size_t i = 0; i < kBurstChannels; ++i) {
    append_value(sample, kChannelNames[i], units_[i], burst.counts[i], tally_.refused);
    if ((burst.is_new >> i & 1U) == 0) sample.flags.push_back(kOldFlags[i]);
  }
  if (burst.alarm != 0) sample.flags.push_back("error_alarm");
  ++tally_.samples;
}

}  // namespace imunoise::drivers::adis16405
