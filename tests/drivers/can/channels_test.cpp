#include "drivers/can/codec/channels.h"

#include <gtest/gtest.h>

#include <numbers>

#include "drivers/can/codec/dbc.h"
#include "drivers/can/codec/decoder.h"
#include "drivers/can/codec/presets.h"
#include "tests/drivers/wire.h"

namespace imunoise::drivers {
namespace {

using testing::decode_all;
using testing::OwnedSample;

constexpr double kDegree = std::numbers::pi / 180.0;

Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::vector<OwnedSample> decode(CanChannels channels, std::string_view text, Tally& tally,
                                std::size_t piece = ~std::size_t{0}) {
  CandumpDecoder decoder(std::move(channels));
  auto out = decode_all(decoder, bytes_of(text), piece);
  tally = decoder.tally();
  return out;
}

OwnedSample decode_one(const char* preset, const char* frame) {
  Tally tally;
  const auto samples = decode(*make_preset(preset), std::string("(1.5) can0 ") + frame, tally);
  EXPECT_EQ(samples.size(), 1U);
  return samples.empty() ? OwnedSample{} : samples[0];
}

TEST(CanPresets, AllAreWhole) {
  for (const std::string_view name : preset_names()) EXPECT_TRUE(make_preset(name)) << name;
  EXPECT_NE(make_preset("nothing").error().message.find("mm5.10"), std::string::npos);
}

TEST(CanPresets, Mti600) {
  const OwnedSample rate = decode_one("mti600", "032#0033FF800500");
  EXPECT_EQ(rate.at("gyro_x"), 0.099609375);
  EXPECT_EQ(rate.at("gyro_y"), -0.25);
  EXPECT_EQ(rate.values[2].unit, "rad/s");
  EXPECT_EQ(rate.clock, Clock::kHost);
  EXPECT_EQ(rate.time_ns, 1'500'000'000);
  EXPECT_EQ(rate.source, "can0");
  EXPECT_EQ(decode_one("mti600", "034#0000000009CF").at("acc_z"), 9.80859375);
  EXPECT_EQ(decode_one("mti600", "041#0400FC000001").at("mag_y"), -1.0);
  EXPECT_EQ(decode_one("mti600", "051#1A80").at("temperature"), 26.5 + 273.15);
  EXPECT_EQ(decode_one("mti600", "005#000F4240").at("sample_time"), 1e6);
  EXPECT_EQ(decode_one("mti600", "021#7FFF000080010000").at("q2"), -1.0);
}

TEST(CanPresets, Aceinna) {
  const OwnedSample rate = decode_one("aceinna", "0CF02A80#807F008080800000");
  EXPECT_NEAR(rate.at("gyro_x"), 5.0 * kDegree, 1e-12);
  EXPECT_NEAR(rate.at("gyro_z"), 7.0 * kDegree, 1e-12);
  EXPECT_NEAR(decode_one("aceinna", "08F02D80#C87D2C7E907E0000").at("acc_y"), 3.0, 1e-12);
  EXPECT_NEAR(decode_one("aceinna", "0CF02980#C7AA7E5C826B4406").at("pitch"), 3.334197998, 1e-9);
}

TEST(CanPresets, AceinnaMarksInvalidValuesByTheirUpperCodes) {
  Tally tally;
  const auto samples =
      decode(*make_preset("aceinna"), "(1.5) can0 0CF02A80#FFFF00FBFFFA0000", tally);
  ASSERT_EQ(samples.size(), 1U);
  ASSERT_EQ(samples[0].values.size(), 1U);
  EXPECT_EQ(samples[0].values[0].channel, "gyro_z");
  EXPECT_EQ(tally.refused.count(Refusal::kOutOfRange), 2U);
}

TEST(CanPresets, AceinnaAtAnotherAddress) {
  const CanPreset preset = aceinna_preset(0x81);
  const auto database = parse_dbc(preset.dbc, "preset");
  ASSERT_TRUE(database);
  EXPECT_NE(database->find(0x0cf02a81, true), nullptr);
  EXPECT_EQ(database->find(0x0cf02a80, true), nullptr);
}

TEST(CanPresets, Mm510) {
  const OwnedSample yaw = decode_one("mm5.10", "174#FFFFFFFFFFFFFFFF");
  EXPECT_NEAR(yaw.at("gyro_z"), 163.835 * kDegree, 1e-12);
  EXPECT_NEAR(yaw.at("acc_y"), 4.176618775 * 9.80665, 1e-9);
  EXPECT_NEAR(decode_one("mm5.10", "17C#000000008B9E0000").at("acc_z"), 0.996621955 * 9.80665,
              1e-9);
  EXPECT_NEAR(decode_one("mm5.10", "178#E47CFFFF1A7E0000").at("gyro_x"), -3.98 * kDegree, 1e-12);
}

constexpr std::string_view kDatabase =
    "BO_ 1 One: 2 I\n SG_ A : 0|8@1+ (1,0) [0|0] \"deg/s\" H\n SG_ B : 8|8@1+ (1,0) [0|0] \"\" H\n"
    "BO_ 2 Two: 1 I\n SG_ C : 0|8@1+ (1,0) [0|0] \"\" H\n";

TEST(CanChannels, MappingNamesAndChooses) {
  const std::vector<ChannelMapping> mapping = {{"One", "B", "acc_x", "mg", {}}};
  auto channels = CanChannels::make(*parse_dbc(kDatabase, "d"), mapping);
  ASSERT_TRUE(channels);
  Tally tally;
  const auto samples = decode(*channels, "(0.0) c 001#0102\n(0.0) c 002#01\n", tally);
  ASSERT_EQ(samples.size(), 1U);
  ASSERT_EQ(samples[0].values.size(), 1U);
  EXPECT_EQ(samples[0].values[0].channel, "acc_x");
  EXPECT_NEAR(samples[0].values[0].value, 2 * 9.80665e-3, 1e-15);
  EXPECT_EQ(tally.other_messages, 1U);
}

TEST(CanChannels, MappingErrorsNameTheThing) {
  const auto error = [](std::vector<ChannelMapping> mapping) {
    return CanChannels::make(*parse_dbc(kDatabase, "d"), mapping).error().message;
  };
  EXPECT_NE(error({{"Three", "A", "x", "", {}}}).find("no message Three"), std::string::npos);
  EXPECT_NE(error({{"One", "C", "x", "", {}}}).find("no signal C"), std::string::npos);
  EXPECT_NE(error({{"One", "A", "x", "", {}}, {"One", "A", "y", "", {}}}).find("channel x already"),
            std::string::npos);
}

TEST(CandumpStream, CountsWhatItRefuses) {
  const std::string text =
      "# a comment\n"
      "(1.0) can0 001#0102\r\n"
      "(1.0) can0 001#01\n"                     // B lies beyond its end
      "(1.0) can0 003#01\n"                     // unknown
      "(1.0) can0 001#R\n"                      // remote
      "(1.0) can0 20000004#0000000000000000\n"  // error frame
      "(1.0) can0 001#0\n"                      // half a byte
      "(1.0) " +
      std::string(1000, 'x') + "\n" +                       // no frame is as long
      std::string(1000, '#') + "\n" + "(2.0) can0 002#07";  // without an end of line
  Tally whole;
  const auto samples = decode(*CanChannels::make(*parse_dbc(kDatabase, "d"), {}), text, whole);
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_EQ(samples[2].at("C"), 7.0);
  EXPECT_EQ(samples[0].values[0].unit, "rad/s");
  EXPECT_EQ(whole.refused.count(Refusal::kLength), 1U);
  EXPECT_EQ(whole.refused.count(Refusal::kUnknownMessage), 1U);
  EXPECT_EQ(whole.refused.count(Refusal::kRemoteFrame), 1U);
  EXPECT_EQ(whole.refused.count(Refusal::kErrorFrame), 1U);
  EXPECT_EQ(whole.refused.count(Refusal::kMalformedLine), 2U);
  for (const std::size_t piece : {1U, 3U, 600U}) {
    Tally tally;
    EXPECT_EQ(decode(*CanChannels::make(*parse_dbc(kDatabase, "d"), {}), text, tally, piece),
              samples);
    EXPECT_EQ(tally.refused, whole.refused) << piece;
  }
}

}  // namespace
}  // namespace imunoise::drivers
