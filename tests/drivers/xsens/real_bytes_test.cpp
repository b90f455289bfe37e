// Vectors and captures that lie beside the project: numbers decoded by others, bytes of real
// devices.

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <map>

#include "drivers/xsens/codec/decoder.h"
#include "drivers/xsens/codec/frame.h"
#include "drivers/xsens/codec/legacy.h"
#include "drivers/xsens/codec/messages.h"
#include "tests/drivers/wire.h"
#include "tests/support/golden.h"

namespace imunoise::drivers {
namespace {

using imunoise::testing::read_json;
using imunoise::testing::shared;
using nlohmann::json;
using testing::decode_all;
using testing::from_hex;
using testing::OwnedSample;

const std::map<std::string, std::vector<const char*>> kChannels = {
    {"Temperature", {"temperature"}},
    {"Quaternion", {"q0", "q1", "q2", "q3"}},
    {"RotationMatrix", {"r11", "r21", "r31", "r12", "r22", "r32", "r13", "r23", "r33"}},
    {"EulerAngles", {"roll", "pitch", "yaw"}},
    {"DeltaV", {"delta_v_x", "delta_v_y", "delta_v_z"}},
    {"Acceleration", {"acc_x", "acc_y", "acc_z"}},
    {"FreeAcceleration", {"free_acc_x", "free_acc_y", "free_acc_z"}},
    {"AltitudeEllipsoid", {"altitude"}},
    {"LatLon", {"latitude", "longitude"}},
    {"RateOfTurn", {"gyro_x", "gyro_y", "gyro_z"}},
    {"DeltaQ", {"delta_q0", "delta_q1", "delta_q2", "delta_q3"}},
    {"MagneticField", {"mag_x", "mag_y", "mag_z"}},
    {"VelocityXYZ", {"velocity_x", "velocity_y", "velocity_z"}},
};

double unix_seconds_of(const json& utc) {
  std::tm calendar{};
  calendar.tm_year = utc["year"].get<int>() - 1900;
  calendar.tm_mon = utc["month"].get<int>() - 1;
  calendar.tm_mday = utc["day"];
  calendar.tm_hour = utc["hour"];
  calendar.tm_min = utc["minute"];
  calendar.tm_sec = utc["second"];
  return static_cast<double>(timegm(&calendar)) + 1e-9 * utc["ns"].get<double>();
}

void expect_flags(const OwnedSample& sample, std::uint32_t status) {
  EXPECT_EQ(sample.has_flag("self_test_passed"), (status & 1U) != 0);
  EXPECT_EQ(sample.has_flag("filter_valid"), (status & 2U) != 0);
  EXPECT_EQ(sample.has_flag("gnss_fix"), (status & 4U) != 0);
  EXPECT_EQ(sample.has_flag("clip_mag_z"), (status >> 16U & 1U) != 0);
  EXPECT_EQ(sample.has_flag("clip_any"), (status >> 19U & 1U) != 0);
}

// Compares one decoded item of the vector; returns false for items that are to be skipped.
bool expect_item(const OwnedSample& sample, const json& item) {
  const std::string name = item["name"];
  const json& value = item["value"];
  if (name == "PacketCounter") {
    EXPECT_EQ(sample.counter, value.get<std::int64_t>());
  } else if (name == "SampleTimeFine") {
    EXPECT_EQ(sample.time_ns, value.get<std::int64_t>() * 100'000);
  } else if (name == "SampleTimeCoarse") {
    EXPECT_EQ(sample.at("sample_time_coarse"), value.get<double>());
  } else if (name == "BaroPressure") {
    EXPECT_EQ(sample.at("pressure"), value.get<double>());
  } else if (name == "UtcTime") {
    EXPECT_NEAR(sample.at("utc"), unix_seconds_of(value), 1e-6);
  } else if (name == "StatusWord" || name == "StatusByte") {
    expect_flags(sample, value.get<std::uint32_t>());
  } else if (name == "GnssPvtData") {
    EXPECT_TRUE(std::isfinite(sample.at("gnss_latitude")));
  } else if (kChannels.contains(name)) {
    const auto& channels = kChannels.at(name);
    EXPECT_EQ(channels.size(), value.size());
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const double offset = name == "Temperature" ? 273.15 : 0.0;
      const double wanted = value[i].get<double>();
      EXPECT_NEAR(sample.at(channels[i]), wanted + offset, 1e-11 * (std::abs(wanted) + offset))
          << channels[i];
    }
  } else {
    return false;
  }
  return true;
}

void expect_legacy(Bytes payload, const json& legacy) {
  const auto hexadecimal = [&](const char* stated, const char* inferred) {
    return std::stoul(
        (legacy.contains(stated) ? legacy[stated] : legacy[inferred]).get<std::string>(), nullptr,
        16);
  };
  const LegacyLayout layout{
      static_cast<std::uint16_t>(hexadecimal("output_mode", "output_mode_inferred")),
      static_cast<std::uint32_t>(hexadecimal("output_settings", "output_settings_inferred"))};
  LegacyData got;
  Refusals refused;
  ASSERT_TRUE(decode_legacy(payload, layout, got, refused));
  const OwnedSample sample = testing::own(got.sample);
  std::size_t compared = 0;
  const auto expect = [&](const char* key, std::vector<const char*> channels) {
    if (!legacy.contains(key)) return;
    for (std::size_t i = 0; i < channels.size(); ++i, ++compared) {
      EXPECT_EQ(sample.at(channels[i]), legacy[key][i].get<double>()) << channels[i];
    }
  };
  expect("acc", {"acc_x", "acc_y", "acc_z"});
  expect("gyr", {"gyro_x", "gyro_y", "gyro_z"});
  expect("mag", {"mag_x", "mag_y", "mag_z"});
  expect("euler_deg", {"roll", "pitch", "yaw"});
  if (legacy.contains("temp")) {
    EXPECT_EQ(sample.at("temperature"), legacy["temp"].get<double>() + 273.15);
    ++compared;
  }
  if (legacy.contains("sample_counter")) {
    EXPECT_EQ(got.counter, legacy["sample_counter"].get<int>());
  }
  EXPECT_EQ(compared, sample.values.size());
}

TEST(XsensVectors, EveryMessageDecodesToItsValues) {
  IMUNOISE_NEEDS("vectors/wire.json");
  std::size_t messages = 0;
  std::size_t items = 0;
  const json entries = read_json("vectors/wire.json")["xbus"];
  for (const json& entry : entries) {
    const auto bytes = from_hex(entry["hex"].get<std::string>());
    SCOPED_TRACE(entry["hex"].get<std::string>());
    ++messages;
    if (!entry.contains("mid")) {  // the payload of an OutputConfiguration alone
      const auto outputs = decode_output_configuration(bytes);
      ASSERT_TRUE(outputs);
      ASSERT_EQ(outputs->size(), entry["decoded"].size());
      for (std::size_t i = 0; i < outputs->size(); ++i, ++items) {
        EXPECT_EQ((*outputs)[i].data_id,
                  std::stoul(entry["decoded"][i]["id"].get<std::string>(), nullptr, 16));
        EXPECT_EQ((*outputs)[i].rate_hz, entry["decoded"][i]["rate"]);
      }
      continue;
    }
    XbusParser parser;
    parser.push(bytes);
    const auto frame = parser.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->message_id, entry["mid"]);
    EXPECT_EQ(frame->payload.size(), entry["payload_len"]);
    EXPECT_EQ(encode_xbus_frame(frame->message_id, frame->payload), bytes);
    if (entry.contains("legacy")) expect_legacy(frame->payload, entry["legacy"]);
    if (!entry.contains("decoded")) continue;

    XbusDecoder decoder;
    const auto samples = decode_all(decoder, bytes);
    ASSERT_EQ(samples.size(), 1U);
    std::size_t skipped = 0;
    for (const json& item : entry["decoded"]) {
      SCOPED_TRACE(item["name"].get<std::string>());
      ++(expect_item(samples[0], item) ? items : skipped);
    }
    EXPECT_EQ(decoder.tally().refused.count(Refusal::kUnknownItem), skipped);
  }
  EXPECT_EQ(messages, 40U);
  EXPECT_GT(items, 100U);
}

TEST(XsensVectors, NegativesAreRefused) {
  IMUNOISE_NEEDS("vectors/wire.json");
  const json negatives = read_json("vectors/wire.json")["xbus_negative"];
  const auto refused_by = [&](std::size_t i) {
    XbusDecoder decoder;
    EXPECT_TRUE(decode_all(decoder, from_hex(negatives[i]["hex"].get<std::string>())).empty());
    return decoder.tally();
  };
  ASSERT_EQ(negatives.size(), 3U);
  EXPECT_EQ(refused_by(0).refused.count(Refusal::kChecksum), 1U);
  EXPECT_EQ(refused_by(1).refused.count(Refusal::kTruncated), 1U);
  EXPECT_EQ(refused_by(2).other_messages, 1U);  // the GoToConfigAck behind the stray preamble
}

class XsensCapture : public ::testing::TestWithParam<int> {
 protected:
  static std::string name() {
    return "captures/xsens/capture" + std::to_string(GetParam()) + ".bin";
  }
  static std::vector<std::uint8_t> bytes() {
    std::ifstream file(shared(name()), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
};

TEST_P(XsensCapture, IsWholeAndPhysical) {
  IMUNOISE_NEEDS(name());
  XbusDecoder decoder;
  const auto samples = decode_all(decoder, bytes());
  ASSERT_EQ(samples.size(), 100U);
  EXPECT_TRUE(decoder.tally().refused.none());
  EXPECT_EQ(decoder.tally().lost, 0U);
  std::size_t receiver = 0;
  std::size_t positions = 0;
  double latitude = std::nan("");
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const OwnedSample& sample = samples[i];
    EXPECT_EQ(*sample.counter, *samples[0].counter + static_cast<std::int64_t>(i));
    if (sample.stream == "gnss") {
      ++receiver;
      // The filter's position and the receiver's: 1e-4 degrees are 11 m.
      if (std::isfinite(latitude)) {
        ++positions;
        EXPECT_NEAR(sample.at("gnss_latitude"), latitude, 1e-4);
      }
      continue;
    }
    // Delta v and delta q are acceleration and rate over the interval of 10 ms; delta q as 12.20
    // has steps of 1e-6.
    EXPECT_NEAR(sample.at("delta_v_y"), 0.01 * sample.at("acc_y"), 2e-5);
    EXPECT_NEAR(sample.at("delta_q1"), 0.005 * sample.at("gyro_x"), 3e-6);
    if (std::isfinite(sample.at("latitude"))) latitude = sample.at("latitude");
    if (i == 0) continue;  // its acceleration had not settled
    EXPECT_NEAR(std::hypot(sample.at("acc_x"), sample.at("acc_y"), sample.at("acc_z")), 9.8, 0.1);
  }
  EXPECT_EQ(receiver, 4U);
  EXPECT_GE(positions, 2U);
}

TEST_P(XsensCapture, DoesNotDependOnThePieces) {
  IMUNOISE_NEEDS(name());
  XbusDecoder whole;
  const auto samples = decode_all(whole, bytes());
  for (const std::size_t piece : {1U, 13U, 4096U}) {
    XbusDecoder decoder;
    EXPECT_EQ(decode_all(decoder, bytes(), piece), samples) << piece;
  }
}

TEST_P(XsensCapture, BegunAnywhereLosesOnlyTheFirstMessage) {
  IMUNOISE_NEEDS(name());
  const auto all = bytes();
  XbusDecoder whole;
  const auto samples = decode_all(whole, all);
  for (std::size_t cut = 1; cut < 100; ++cut) {
    XbusDecoder decoder;
    const auto rest = decode_all(decoder, Bytes(all).subspan(cut));
    ASSERT_EQ(rest.size(), 99U) << cut;
    EXPECT_EQ(rest.front(), samples[1]) << cut;
    EXPECT_FALSE(decoder.tally().refused.none());
  }
}

INSTANTIATE_TEST_SUITE_P(Float32Fixed12Fixed16, XsensCapture, ::testing::Values(1, 2, 3));

}  // namespace
}  // namespace imunoise::drivers
