#include "drivers/adis16405/codec/burst.h"

#include <gtest/gtest.h>

#include <random>

#include "drivers/adis16405/codec/decoder.h"
#include "drivers/adis16405/codec/registers.h"
#include "tests/drivers/wire.h"
#include "tests/support/golden.h"

namespace imunoise::drivers::adis16405 {
namespace {

using drivers::testing::decode_all;
using drivers::testing::from_hex;
using imunoise::testing::read_json;
using nlohmann::json;

constexpr std::uint16_t kAll = 0x0fff;

// Counts of channel i that its bits can hold.
std::int16_t random_counts(std::mt19937_64& random, std::size_t i) {
  const bool twelve = i >= 10;
  const bool positive = i == 0 || i == 11;
  const int span = twelve ? 4096 : 16384;
  return static_cast<std::int16_t>(static_cast<int>(random() % static_cast<unsigned>(span)) -
                                   (positive ? 0 : span / 2));
}

TEST(Adis16405Burst, Returns) {
  constexpr std::uint64_t kSeed = 6;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  for (int round = 0; round < 2000; ++round) {
    Burst sent;
    for (std::size_t i = 0; i < kBurstChannels; ++i) sent.counts[i] = random_counts(random, i);
    sent.is_new = static_cast<std::uint16_t>((random() & kAll) | 0x7eU);
    sent.alarm = static_cast<std::uint16_t>(random() & kAll);
    const auto bytes = encode_burst(sent);
    ASSERT_EQ(bytes.size(), kBurstBytes);
    const auto got = decode_burst(bytes);
    ASSERT_TRUE(got);
    EXPECT_EQ(*got, sent);
  }
}

TEST(Adis16405Burst, SaturatesAsTheSensorDoes) {
  Burst sent;
  sent.is_new = kAll;
  sent.counts.fill(20000);
  sent.counts[0] = sent.counts[11] = -5;
  sent.counts[2] = -20000;
  const auto got = decode_burst(encode_burst(sent));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->counts[0], 0);
  EXPECT_EQ(got->counts[1], 8191);
  EXPECT_EQ(got->counts[2], -8192);
  EXPECT_EQ(got->counts[10], 2047);
  EXPECT_EQ(got->counts[11], 0);
}

TEST(Adis16405Burst, RefusesWhatIsNotOneNewSample) {
  Burst burst;
  burst.is_new = kAll;
  const auto refusal = [&](std::uint16_t is_new) {
    burst.is_new = is_new;
    const auto got = decode_burst(encode_burst(burst));
    return got ? "none" : name_of(got.error());
  };
  EXPECT_EQ(refusal(kAll), "none");
  EXPECT_EQ(refusal(0x007e), "none");  // the slow channels may be old
  EXPECT_EQ(refusal(0), "stale");
  EXPECT_EQ(refusal(kAll & ~0x7eU), "stale");
  for (unsigned i = 1; i <= 6; ++i) {
    EXPECT_EQ(refusal(static_cast<std::uint16_t>(kAll & ~(1U << i))), "torn") << kChannelNames[i];
  }
  EXPECT_EQ(decode_burst(std::vector<std::uint8_t>(26, 0xff)).error(), Refusal::kNoAnswer);
  EXPECT_EQ(decode_burst(std::vector<std::uint8_t>(26, 0x00)).error(), Refusal::kStale);
  EXPECT_EQ(decode_burst(std::vector<std::uint8_t>(25, 0x80)).error(), Refusal::kLength);
}

TEST(Adis16405Stream, NumbersAreSiAndTimeIsNominal) {
  Burst burst;
  burst.is_new = kAll & ~(1U << 7U);
  burst.counts = {2092, 1000, 0, 0, 300, 0, 0, 0, 0, 0, -100, 0};
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 3; ++i) {
    burst.alarm = i == 2 ? 1 : 0;
    const auto one = encode_burst(burst);
    bytes.insert(bytes.end(), one.begin(), one.end());
  }
  bytes.insert(bytes.end(), 7, 0x80);
  BurstDecoder decoder(*count_scales(0x0102 | 4), sample_rate(0x0001));
  const auto samples = decode_all(decoder, bytes, 5);
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_NEAR(samples[0].at("gyro_x"), 12.5 * 3.14159265358979 / 180.0, 1e-12);  // ±75 °/s
  EXPECT_NEAR(samples[0].at("acc_x"), 0.999 * 9.80665, 1e-12);
  EXPECT_NEAR(samples[0].at("temperature"), 11.0 + 273.15, 1e-12);
  EXPECT_EQ(samples[0].flags, std::vector<std::string>{"old_mag_x"});
  EXPECT_TRUE(samples[2].has_flag("error_alarm"));
  EXPECT_EQ(samples[2].clock, Clock::kNominal);
  EXPECT_NEAR(static_cast<double>(samples[2].time_ns), 2e9 / 819.2, 1e4);
  EXPECT_EQ(decoder.tally().refused.count(Refusal::kTruncated), 1U);
}

TEST(Adis16405Vectors, EveryBurstDecodesToItsValues) {
  IMUNOISE_NEEDS("vectors/wire.json");
  const json entries = read_json("vectors/wire.json")["adis16405_burst"];
  ASSERT_EQ(entries.size(), 6U);
  std::size_t stale = 0;
  for (const json& entry : entries) {
    SCOPED_TRACE(entry["rx_hex"].get<std::string>());
    auto bytes = from_hex(entry["rx_hex"].get<std::string>());
    if (entry["nd"][1] == 0) {
      ++stale;
      EXPECT_EQ(decode_burst(bytes).error(), Refusal::kStale);
      continue;
    }
    const auto got = decode_burst(bytes);
    ASSERT_TRUE(got);
    const auto scales = count_scales(kDefaultSensitivityAveraging);
    ASSERT_TRUE(scales);
    const auto expect = [&](std::size_t channel, const json& counts, const json& physical) {
      EXPECT_EQ(got->counts[channel], counts.get<int>()) << kChannelNames[channel];
      const CountScale& scale = (*scales)[channel];
      EXPECT_NEAR(got->counts[channel] * scale.scale + scale.offset, physical.get<double>(), 1e-9);
    };
    const json& counts = entry["counts"];
    const json& decoded = entry["decoded"];
    expect(0, counts["supply"], decoded["supply_V"]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      expect(1 + axis, counts["gyro"][axis], decoded["gyro_dps_at_300"][axis]);
      expect(4 + axis, counts["accel"][axis], decoded["accel_g"][axis]);
      expect(7 + axis, counts["magn"][axis], decoded["magn_gauss"][axis]);
    }
    expect(10, counts["temp"], decoded["temp_C"]);
    expect(11, counts["aux_adc"], decoded["aux_adc_V"]);
    for (std::size_t i = 0; i < kBurstChannels; ++i) {
      EXPECT_EQ(std::uint32_t{got->is_new} >> i & 1U, entry["nd"][i].get<unsigned>());
      EXPECT_EQ(std::uint32_t{got->alarm} >> i & 1U, entry["ea"][i].get<unsigned>());
    }
  }
  EXPECT_EQ(stale, 1U);
}

// A flight computer's log writes the 14 bits of each word as an unsigned number.
TEST(Adis16405Vectors, EveryLogLineDecodesToItsValues) {
  IMUNOISE_NEEDS("vectors/wire.json");
  const json entries = read_json("vectors/wire.json")["adis16405_log"];
  ASSERT_EQ(entries.size(), 5U);
  const std::array<const char*, 3> groups = {"accel", "gyro", "magn"};
  const std::array<const char*, 3> physical = {"accel_g", "gyro_dps", "magn_gauss"};
  const std::array<std::size_t, 3> channels = {4, 1, 7};
  for (const json& entry : entries) {
    std::stringstream line(entry["line"].get<std::string>());
    std::string field;
    std::getline(line, field, ',');
    std::getline(line, field, ',');
    std::array<std::uint16_t, kBurstChannels> words{};
    for (const std::size_t first : channels) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::getline(line, field, ',');
        words[first + axis] = static_cast<std::uint16_t>(0x8000U | std::stoul(field));
      }
    }
    std::vector<std::uint8_t> bytes = {0, 0};
    for (const std::uint16_t word : words) append_big_endian(bytes, word);
    const auto got = decode_burst(bytes);
    ASSERT_TRUE(got);
    for (std::size_t group = 0; group < 3; ++group) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t channel = channels[group] + axis;
        EXPECT_EQ(got->counts[channel], entry["counts"][groups[group]][axis].get<int>());
        EXPECT_NEAR(got->counts[channel] * (*count_scales(0x0402))[channel].scale,
                    entry["decoded"][physical[group]][axis].get<double>(), 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace imunoise::drivers::adis16405
