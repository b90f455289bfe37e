#include "drivers/xsens/codec/legacy.h"

#include <gtest/gtest.h>

#include <random>

#include "drivers/xsens/codec/decoder.h"
#include "drivers/xsens/codec/messages.h"
#include "tests/drivers/wire.h"

namespace imunoise::drivers {
namespace {

using testing::decode_all;
using testing::from_hex;

std::size_t numbers_in(LegacyLayout layout) {
  // Written from the documents' tables, group by group.
  const auto mode = [&](unsigned bit) { return (layout.mode & bit) != 0; };
  const auto setting = [&](unsigned bit) { return (layout.settings & bit) != 0; };
  std::size_t out = 0;
  if (mode(0x4000)) out += 10;
  if (mode(0x1000)) out += 13;
  if (mode(0x0001)) out += 1;
  if (mode(0x0002))
    out += (setting(0x10) ? 0U : 3U) + (setting(0x20) ? 0U : 3U) + (setting(0x40) ? 0U : 3U);
  if (mode(0x0004)) out += setting(0x4) ? 3U : setting(0x8) ? 9U : 4U;
  if (mode(0x0008)) out += (setting(0x400) ? 0U : 1U) + (setting(0x800) ? 0U : 1U);
  if (mode(0x0010)) out += 3;
  if (mode(0x0020)) out += 3;
  return out;
}

TEST(Legacy, EveryLayoutReturns) {
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  constexpr std::uint32_t kModes = 0x583f;
  constexpr std::uint32_t kSettings = 0x80000f7f;
  for (int round = 0; round < 2000; ++round) {
    LegacyLayout layout{static_cast<std::uint16_t>(random() & kModes),
                        static_cast<std::uint32_t>(random() & kSettings)};
    std::vector<double> numbers;
    for (std::size_t i = 0; i < numbers_in(layout); ++i) {
      numbers.push_back(static_cast<double>(random() % 200));  // fits every field
    }
    const auto counter = static_cast<std::uint16_t>(random());
    const auto payload = encode_legacy(layout, numbers, 0x07, counter, {0, 2024, 1, 2, 3, 4, 5, 0});
    LegacyData got;
    Refusals refused;
    ASSERT_TRUE(decode_legacy(payload, layout, got, refused));
    EXPECT_TRUE(refused.none());
    const bool utc = (layout.settings & 2U) != 0;
    ASSERT_EQ(got.sample.values.size(), numbers.size() + (utc ? 1 : 0));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const double offset = got.sample.values[i].channel == "temperature" ? 273.15 : 0.0;
      EXPECT_NEAR(got.sample.values[i].value, numbers[i] + offset, 1e-9)
          << got.sample.values[i].channel;
    }
    EXPECT_EQ(got.counter.has_value(), (layout.settings & 1U) != 0);
    if (got.counter) {
      EXPECT_EQ(*got.counter, counter);
    }

    // One byte more or less is not this layout.
    auto longer = payload;
    longer.push_back(0);
    EXPECT_FALSE(decode_legacy(longer, layout, got, refused));
    if (!payload.empty()) {
      EXPECT_FALSE(decode_legacy(Bytes(payload).first(payload.size() - 1), layout, got, refused));
    }
  }
}

TEST(Legacy, ConfigurationReturns) {
  const XsensConfiguration wanted{0x00300123, 1152, 2, {0x0837, 0x80000045}};
  const auto payload = encode_configuration(wanted);
  EXPECT_EQ(payload.size(), 118U);
  const auto got = decode_configuration(payload);
  ASSERT_TRUE(got);
  EXPECT_EQ(*got, wanted);
  EXPECT_FALSE(decode_configuration(Bytes(payload).first(117)));
}

TEST(Legacy, NeedsTheConfigurationFirst) {
  const auto data = from_hex("faff321a3fc00000c0200000411c00003dcccccd3e4ccccd3e99999a0001a9");
  const auto configuration = encode_message(XsensMessage::kConfiguration,
                                            encode_configuration({1, 1152, 0, {0x0002, 0x0041}}));
  std::vector<std::uint8_t> bytes = data;
  bytes.insert(bytes.end(), configuration.begin(), configuration.end());
  bytes.insert(bytes.end(), data.begin(), data.end());
  XbusDecoder decoder;
  const auto samples = decode_all(decoder, bytes);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ(decoder.tally().refused.count(Refusal::kNoLayout), 1U);
  EXPECT_EQ(samples[0].counter, 1);
  EXPECT_EQ(samples[0].clock, Clock::kNone);
  EXPECT_EQ(samples[0].at("acc_y"), -2.5);
  EXPECT_EQ(samples[0].at("gyro_x"), static_cast<double>(0.1F));
}

}  // namespace
}  // namespace imunoise::drivers
