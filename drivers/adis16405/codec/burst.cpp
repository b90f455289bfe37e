#include "drivers/adis16405/codec/burst.h"

#include <algorithm>

namespace imunoise::drivers::adis16405 {

const std::array<std::string_view, kBurstChannels> kChannelNames = {
    "supply", "gyro_x", "gyro_y", "gyro_z", "acc_x",       "acc_y",
    "acc_z",  "mag_x",  "mag_y",  "mag_z",  "temperature", "aux_adc"};

namespace {

constexpr std::uint16_t kNew = 0x8000;
constexpr std::uint16_t kAlarm = 0x4000;

struct Format {
  unsigned bits;
  bool is_signed;
};

constexpr std::array<Format, kBurstChannels> kFormats = {{{14, false},
                                                          {14, true},
                                                          {14, true},
                                                          {14, true},
                                                          {14, true},
                                                          {14, true},
                                                          {14, true},
                                                          {14, true},
                                                          {14, true},
                                                          {14, true},
                                                          {12, true},
                                                          {12, false}}};

std::int16_t counts_of(std::uint16_t word, Format format) {
  const int modulus = 1 << format.bits;
  const int value = word & (modulus - 1);
  return static_cast<std::int16_t>(format.is_signed && value >= modulus / 2 ? value - modulus
                                                                            : value);
}

std::uint16_t word_of(std::int16_t counts, Format format) {
  const int modulus = 1 << format.bits;
  const int lowest = format.is_signed ? -modulus / 2 : 0;
  const int value = std::clamp(static_cast<int>(counts), lowest, lowest + modulus - 1);
  return static_cast<std::uint16_t>(value & (modulus - 1));
}

}  // namespace

Result<std::array<CountScale, kBurstChannels>> count_scales(std::uint16_t sensitivity_averaging) {
  const Result<double> range = gyro_range(sensitivity_averaging);
  if (!range) return tl::unexpected(range.error());
  const CountScale supply{"V", 2.418e-3};
  const CountScale gyro{"deg/s", *range / 6000.0};  // 0.05 °/s at ±300 °/s
  const CountScale acc{"g", 3.33e-3};
  const CountScale mag{"gauss", 0.5e-3};
  const CountScale temperature{"degC", 0.14, 25.0};
  const CountScale aux{"V", 806e-6};
  return std::array<CountScale, kBurstChannels>{supply, gyro, gyro, gyro, acc,         acc,
                                                acc,    mag,  mag,  mag,  temperature, aux};
}

std::array<SiUnit, kBurstChannels> si_scales(const std::array<CountScale, kBurstChannels>& scales) {
  std::array<SiUnit, kBurstChannels> out;
  for (std::size_t i = 0; i < kBurstChannels; ++i) {
    const SiUnit si = si_unit(scales[i].unit);
    out[i] = {si.symbol, scales[i].scale * si.scale, scales[i].offset * si.scale + si.offset};
  }
  return out;
}

tl::expected<Burst, Refusal> parse_burst(Bytes bytes) {
  if (bytes.size() != kBurstBytes) return tl::unexpected(Refusal::kLength);
  BigEndianReader in(bytes.subspan(2));
  Burst out;
  bool all_ones = true;
  for (std::size_t i = 0; i < kBurstChannels; ++i) {
    const auto word = in.take<std::uint16_t>();
    all_ones = all_ones && word == 0xffff;
    out.counts[i] = counts_of(word, kFormats[i]);
    if ((word & kNew) != 0) out.is_new = static_cast<std::uint16_t>(out.is_new | 1U << i);
    if ((word & kAlarm) != 0) out.alarm = static_cast<std::uint16_t>(out.alarm | 1U << i);
  }
  if (all_ones) return tl::unexpected(Refusal::kNoAnswer);
  return out;
}

tl::expected<Burst, Refusal> decode_burst(Bytes bytes) {
  const auto burst = parse_burst(bytes);
  if (!burst) return burst;
  const unsigned inertial = burst->is_new & kInertialChannels;
  if (inertial == 0) return tl::unexpected(Refusal::kStale);
  if (inertial != kInertialChannels) return tl::unexpected(Refusal::kTorn);
  return burst;
}

std::vector<std::uint8_t> encode_burst(const Burst& burst) {
  std::vector<std::uint8_t> out;
  out.reserve(kBurstBytes);
  append_big_endian(out, std::uint16_t{0xffff});
  for (std::size_t i = 0; i < kBurstChannels; ++i) {
    unsigned word = word_of(burst.counts[i], kFormats[i]);
    if ((burst.is_new >> i & 1U) != 0) word |= kNew;
    if ((burst.alarm >> i & 1U) != 0) word |= kAlarm;
    append_big_endian(out, static_cast<std::uint16_t>(word));
  }
  return out;
}

}  // namespace imunoise::drivers::adis16405
