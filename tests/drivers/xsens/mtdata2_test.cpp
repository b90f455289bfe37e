#include "drivers/xsens/codec/mtdata2.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "drivers/xsens/codec/decoder.h"
#include "drivers/xsens/codec/messages.h"
#include "tests/drivers/wire.h"

namespace imunoise::drivers {
namespace {

using testing::decode_all;
using testing::from_hex;
using testing::OwnedSample;

constexpr std::array kFormats = {XsensFormat::kFloat32, XsensFormat::kFixed12_20,
                                 XsensFormat::kFixed16_32, XsensFormat::kFloat64};

double round_trip(XsensFormat format, double value) {
  std::vector<std::uint8_t> bytes;
  append_number(bytes, format, value);
  EXPECT_EQ(bytes.size(), size_of(format));
  BigEndianReader in(bytes);
  return take_number(in, format);
}

TEST(XsensNumber, ReturnsWithinItsResolution) {
  constexpr std::uint64_t kSeed = 4;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> values(-2000.0, 2000.0);
  for (int i = 0; i < 1000; ++i) {
    const double x = values(random);
    EXPECT_EQ(round_trip(XsensFormat::kFloat64, x), x);
    EXPECT_EQ(round_trip(XsensFormat::kFloat32, x), static_cast<double>(static_cast<float>(x)));
    EXPECT_NEAR(round_trip(XsensFormat::kFixed12_20, x), x, std::ldexp(0.5, -20));
    EXPECT_NEAR(round_trip(XsensFormat::kFixed16_32, x), x, std::ldexp(0.5, -32));
  }
}

TEST(XsensNumber, FixedPointHasTheDocumentedBytesAndSaturates) {
  std::vector<std::uint8_t> bytes;
  append_number(bytes, XsensFormat::kFixed16_32, -0.25);
  EXPECT_EQ(bytes, from_hex("c0000000ffff"));
  bytes.clear();
  append_number(bytes, XsensFormat::kFixed12_20, -0.25);
  EXPECT_EQ(bytes, from_hex("fffc0000"));
  EXPECT_EQ(round_trip(XsensFormat::kFixed12_20, 1e6), std::ldexp(1.0, 11) - std::ldexp(1.0, -20));
  EXPECT_EQ(round_trip(XsensFormat::kFixed12_20, -1e6), -2048.0);
  EXPECT_EQ(round_trip(XsensFormat::kFixed16_32, 1e6), std::ldexp(1.0, 15) - std::ldexp(1.0, -32));
}

std::vector<OwnedSample> decode(const std::vector<std::uint8_t>& bytes, Tally& tally) {
  XbusDecoder decoder;
  auto out = decode_all(decoder, bytes);
  tally = decoder.tally();
  return out;
}

void append_message(std::vector<std::uint8_t>& bytes, const MtData2Writer& writer) {
  const auto frame = encode_message(XsensMessage::kMtData2, writer.payload());
  bytes.insert(bytes.end(), frame.begin(), frame.end());
}

TEST(MtData2, ItemsReturnInEveryFormat) {
  struct Item {
    XsensItem item;
    std::vector<const char*> channels;
    double offset = 0.0;
  };
  const std::vector<Item> items = {
      {XsensItem::kTemperature, {"temperature"}, 273.15},
      {XsensItem::kQuaternion, {"q0", "q1", "q2", "q3"}},
      {XsensItem::kRotationMatrix, {"r11", "r21", "r31", "r12", "r22", "r32", "r13", "r23", "r33"}},
      {XsensItem::kEulerAngles, {"roll", "pitch", "yaw"}},
      {XsensItem::kDeltaV, {"delta_v_x", "delta_v_y", "delta_v_z"}},
      {XsensItem::kAcceleration, {"acc_x", "acc_y", "acc_z"}},
      {XsensItem::kFreeAcceleration, {"free_acc_x", "free_acc_y", "free_acc_z"}},
      {XsensItem::kAccelerationHr, {"acc_hr_x", "acc_hr_y", "acc_hr_z"}},
      {XsensItem::kAltitude, {"altitude"}},
      {XsensItem::kPositionEcef, {"ecef_x", "ecef_y", "ecef_z"}},
      {XsensItem::kLatLon, {"latitude", "longitude"}},
      {XsensItem::kRateOfTurn, {"gyro_x", "gyro_y", "gyro_z"}},
      {XsensItem::kDeltaQ, {"delta_q0", "delta_q1", "delta_q2", "delta_q3"}},
      {XsensItem::kRateOfTurnHr, {"gyro_hr_x", "gyro_hr_y", "gyro_hr_z"}},
      {XsensItem::kMagneticField, {"mag_x", "mag_y", "mag_z"}},
      {XsensItem::kVelocity, {"velocity_x", "velocity_y", "velocity_z"}},
  };
  for (const XsensFormat format : kFormats) {
    for (const Item& item : items) {
      std::vector<double> values;
      for (std::size_t i = 0; i < item.channels.size(); ++i) {
        values.push_back(0.125 * static_cast<double>(i + 1) * (i % 2 == 0 ? 1.0 : -1.0));
      }
      MtData2Writer writer;
      writer.numbers(item.item, format, values);
      std::vector<std::uint8_t> bytes;
      append_message(bytes, writer);
      Tally tally;
      const auto samples = decode(bytes, tally);
      ASSERT_EQ(samples.size(), 1U);
      ASSERT_EQ(samples[0].values.size(), values.size());
      for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(samples[0].at(item.channels[i]), values[i] + item.offset) << item.channels[i];
      }
    }
  }
}

TEST(MtData2, StatusUtcPressureAndFrameReturn) {
  MtData2Writer writer;
  writer.status_word(1U << 1U | 1U << 8U | 1U << 13U | 1U << 19U | 1U << 30U);
  writer.utc({500'000'000, 2024, 2, 29, 23, 59, 59, 0x37});
  writer.pressure(101325);
  writer.raw(static_cast<std::uint16_t>(XsensItem::kEulerAngles) | 4U,
             from_hex("3f80000040000000bf800000"));
  std::vector<std::uint8_t> bytes;
  append_message(bytes, writer);
  Tally tally;
  const auto samples = decode(bytes, tally);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ(samples[0].flags, (std::vector<std::string>{"filter_valid", "clip_acc_x", "clip_gyro_z",
                                                        "clip_any", "ned"}));
  EXPECT_EQ(samples[0].at("utc"), 1709251199.5);  // date -u -d '2024-02-29 23:59:59' +%s
  EXPECT_EQ(samples[0].at("pressure"), 101325.0);
  EXPECT_EQ(samples[0].at("pitch"), 2.0);
  EXPECT_TRUE(tally.refused.none());
}

TEST(MtData2, CounterAndTimeGoOnThroughTheirWraps) {
  std::vector<std::uint8_t> bytes;
  constexpr std::int64_t kFirst = 65530;
  constexpr std::int64_t kFirstTicks = kXsensDayTicks - 550;
  for (std::int64_t i = 0; i < 20; ++i) {
    if (i == 12 || i == 13) continue;  // lost on the way
    MtData2Writer writer;
    writer.packet_counter(static_cast<std::uint16_t>(kFirst + i));
    writer.sample_time_fine(static_cast<std::uint32_t>((kFirstTicks + 100 * i) % kXsensDayTicks));
    append_message(bytes, writer);
  }
  Tally tally;
  const auto samples = decode(bytes, tally);
  ASSERT_EQ(samples.size(), 18U);
  EXPECT_EQ(samples.back().counter, kFirst + 19);
  EXPECT_EQ(samples.back().time_ns, (kFirstTicks + 1900) * 100'000);
  EXPECT_EQ(samples.back().clock, Clock::kDevice);
  EXPECT_EQ(tally.lost, 2U);
}

TEST(MtData2, ASampleTimeAboveADayWrapsAt32Bits) {
  std::vector<std::uint8_t> bytes;
  for (const std::uint32_t ticks : {4'294'967'190U, 4'294'967'290U, 94U}) {
    MtData2Writer writer;
    writer.sample_time_fine(ticks);
    append_message(bytes, writer);
  }
  Tally tally;
  const auto samples = decode(bytes, tally);
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_EQ(samples[2].time_ns - samples[0].time_ns, 200 * 100'000);
}

TEST(MtData2, RefusesWhatItCannotRead) {
  MtData2Writer writer;
  writer.packet_counter(7);
  writer.raw(0x7777, from_hex("0102030405"));                 // unknown
  writer.raw(0x4020, from_hex("0102"));                       // too short for three numbers
  writer.raw(0x1060, from_hex("01"));                         // too short
  writer.raw(0x0810, from_hex("7fc00000"));                   // NaN
  writer.utc({0, 2004, 0, 0, 0, 0, 0, 0});                    // no such month
  writer.raw(0x7010, from_hex("00"));                         // no solution has one byte
  writer.raw(0x7020, from_hex("0000000002000000 01020304"));  // two satellites announced, one there
  std::vector<std::uint8_t> payload(writer.payload().begin(), writer.payload().end());
  payload.insert(payload.end(), {0x40, 0x20, 0x0c, 0x00});  // cut off
  Tally tally;
  const auto samples = decode(encode_message(XsensMessage::kMtData2, payload), tally);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ(samples[0].counter, 7);
  EXPECT_TRUE(samples[0].values.empty());
  EXPECT_EQ(tally.refused.count(Refusal::kUnknownItem), 1U);
  EXPECT_EQ(tally.refused.count(Refusal::kLength), 5U);
  EXPECT_EQ(tally.refused.count(Refusal::kNotFinite), 1U);
  EXPECT_EQ(tally.refused.count(Refusal::kOutOfRange), 1U);
}

TEST(MtData2, CountsAcknowledgementsAndErrorsOfTheDevice) {
  std::vector<std::uint8_t> bytes = from_hex("faff3100d0 faff420104ba");
  Tally tally;
  EXPECT_TRUE(decode(bytes, tally).empty());
  EXPECT_EQ(tally.other_messages, 1U);
  EXPECT_EQ(tally.refused.count(Refusal::kDeviceError), 1U);
}

}  // namespace
}  // namespace imunoise::drivers
