// The driver "emulated" as a recorder uses it, and devices served to the real drivers.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "drivers/emulator/serving/serve.h"
#include "tests/drivers/recording_session.h"

namespace imunoise::testing {
namespace {

using Options = std::vector<drivers::OptionText>;
using Session = std::unique_ptr<RecordingSession>;

constexpr double kDegree = std::numbers::pi / 180.0;

// Noise of 2 °/s and a step of 20 °/s after two seconds.
Options options_of(const std::string& device, Options more = {}) {
  Options out = {{"device", device},
                 {"model", "gyro: WN(sigma2=1.2e-3)"},
                 {"effect", "step(at=2, height=0.35, channel=gyro_y)"},
                 {"seed", "5"}};
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

Session open(const Options& options, const std::string& driver = "emulated") {
  auto out = RecordingSession::open(IMUNOISE_DRIVER_FOLDER, driver, options);
  if (!out) throw std::runtime_error(out.error().message);
  return std::move(*out);
}

struct Place {
  std::size_t stream = 0;
  std::size_t channel = 0;
};
Place find(const RecordingSession& session, const std::string& channel) {
  const auto& streams = session.info().streams;
  for (std::size_t s = 0; s < streams.size(); ++s) {
    for (std::size_t c = 0; c < streams[s].channels.size(); ++c) {
      if (streams[s].channels[c].name == channel) return {s, c};
    }
  }
  throw std::runtime_error("no channel " + channel);
}

// A channel's values in its units.
std::vector<double> values(const RecordingSession& session, const std::string& name) {
  const Place place = find(session, name);
  const drivers::Channel& channel = session.info().streams[place.stream].channels[place.channel];
  std::vector<double> out;
  for (const ReadRow& row : session.rows(place.stream)) {
    out.push_back(channel.add_offset + channel.scale_factor * row.numbers[place.channel]);
  }
  return out;
}

struct Moments {
  double mean = 0.0;
  double deviation = 0.0;
};
Moments moments(const std::vector<double>& values, std::size_t from, std::size_t to) {
  Moments out;
  const auto n = static_cast<double>(to - from);
  for (std::size_t i = from; i < to; ++i) out.mean += values[i] / n;
  for (std::size_t i = from; i < to; ++i) out.deviation += std::pow(values[i] - out.mean, 2) / n;
  out.deviation = std::sqrt(out.deviation);
  return out;
}

TEST(EmulatedDriver, DevicesOfOneKindAreToldApartByTheirSerialNumbers) {
  for (const char* const device : {"adis16405", "xsens"}) {
    const std::string known = open(options_of(device))->info().serial;
    EXPECT_FALSE(known.empty());
    EXPECT_NE(known, "AB107");
    EXPECT_EQ(open(options_of(device, {{"serial", "AB107"}}))->info().serial, "AB107") << device;
  }
}

TEST(EmulatedDriver, AnAdis16405RunsAsFastAsItIsRead) {
  const Session session = open(options_of("adis16405", {{"speed", "0"}, {"rate", "819.2"}}));
  EXPECT_EQ(session->info().product, "ADIS16405 (emulated)");
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(session->read_rows(16'384));  // 20 s
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(15));
  const auto rates = values(*session, "gyro_y");  // deg/s
  const Moments before = moments(rates, 0, 819);  // start-up takes 0.6 s of the two
  const Moments after = moments(rates, 1638, rates.size());
  EXPECT_NEAR(after.mean - before.mean, 0.35 / kDegree, 5.0 * 2.0 / std::sqrt(819.0));
  EXPECT_NEAR(after.deviation, std::sqrt(1.2e-3) / kDegree, 0.06);
  EXPECT_EQ(session->all_refused(), 0U);
}

// Replicates of one recording are openings of one device.
TEST(EmulatedDriver, OpenedAgainADeviceGoesOnWithOtherNumbers) {
  const Options options = options_of("adis16405", {{"speed", "0"}});
  const Session one = open(options);
  const Session two = open(options);
  ASSERT_TRUE(one->read_rows(500));
  ASSERT_TRUE(two->read_rows(500));
  std::size_t same = 0;
  for (std::size_t i = 0; i < 500; ++i) {
    same += one->rows()[i].numbers == two->rows()[i].numbers ? 1U : 0U;
  }
  EXPECT_EQ(same, 0U);
}

TEST(EmulatedDriver, AnAdis16405KeepsTime) {
  const Session session = open(options_of("adis16405", {{"speed", "4"}}));
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(session->read_rows(410));  // 4 s of it, and 0.6 s to start, in a quarter of that
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
  EXPECT_GT(passed.count(), 0.9);
}

TEST(EmulatedDriver, AnAdis16405IsUnpluggedAndComesBack) {
  const Session session =
      open(options_of("adis16405", {{"speed", "20"}, {"fault", "unplug(sample=300, count=30)"}}));
  ASSERT_TRUE(session->read_rows(600)) << session->failure();
  EXPECT_FALSE(session->disconnections().empty());
  EXPECT_NE(session->notes().find("is back"), std::string::npos) << session->notes();
}

TEST(EmulatedDriver, AnMtiMeasuresOnItsLine) {
  const Session session = open(options_of("xsens", {{"rate", "400"}}));
  EXPECT_EQ(session->info().product, "MTi-G-710-2A8G4 (emulated)");
  ASSERT_TRUE(session->read_rows(1200)) << session->failure();
  const auto rates = values(*session, "gyro_x");  // rad/s
  EXPECT_NEAR(moments(rates, 0, rates.size()).deviation, std::sqrt(1.2e-3), 5.0 * 0.035 / 49.0);
  const auto forces = values(*session, "acc_z");
  EXPECT_NEAR(moments(forces, 0, forces.size()).mean, 9.80665, 1e-5);
}

TEST(EmulatedDriver, ACanImuNeedsNoKernelWithCan) {
  const Session session = open(options_of("can", {{"rate", "200"}}));
  EXPECT_EQ(session->info().product, "mti600 (emulated)");
  const Place gyro = find(*session, "gyro_y");
  ASSERT_TRUE(session->read_rows(800, gyro.stream)) << session->failure();
  const auto rates = values(*session, "gyro_y");
  EXPECT_NEAR(moments(rates, 600, 800).mean - moments(rates, 0, 100).mean, 0.35,
              5.0 * 0.035 / std::sqrt(70.0));
  EXPECT_GT(session->rows(gyro.stream).front().host_time_ns, 1'700'000'000'000'000'000);
}

TEST(EmulatedDriver, SaysWhatItCannotBe) {
  const auto refused = [](const Options& options, const std::string& words) {
    const auto session = RecordingSession::open(IMUNOISE_DRIVER_FOLDER, "emulated", options);
    ASSERT_FALSE(session) << words;
    EXPECT_NE(session.error().message.find(words), std::string::npos) << session.error().message;
  };
  refused({}, "device");
  refused({{"device", "adis16405"}, {"model", "gyro: WN"}}, "leaves values open");
  refused({{"device", "adis16405"}, {"effect", "wind()"}}, "no effect 'wind'");
  refused({{"device", "adis16405"}, {"fault", "bit_error(sample=3)"}}, "carry no checksum");
  refused({{"device", "adis16405"}, {"rate", "700"}}, "cannot sample at 700 Hz");
  refused({{"device", "xsens"}, {"speed", "0"}}, "runs in real time");
  refused({{"device", "xsens"}, {"rate", "10.5"}}, "whole number");
  refused({{"device", "can"}, {"fault", "flood(sample=3)"}}, "no fault 'flood'");
}

class Served : public ::testing::Test {
 protected:
  std::string place_ =
      (std::filesystem::temp_directory_path() / ("imunoise_served_" + std::to_string(getpid())))
          .string();
};

TEST_F(Served, AnMtiThatIsUnpluggedIsFoundAgain) {
  const auto mti = emulator::serve({.driver = "xsens",
                                    .place = place_,
                                    .source = {},
                                    .faults = {"unplug(sample=50, count=20)"}});
  ASSERT_TRUE(mti) << mti.error().message;
  EXPECT_EQ((*mti)->device_text(), "xsens port=pty:" + place_);
  const Session session = open({{"port", "pty:" + place_}}, "xsens");
  ASSERT_TRUE(session->read_rows(150)) << session->failure();
  EXPECT_FALSE(session->disconnections().empty());
  EXPECT_GE((*mti)->messages(), 150U);
}

TEST_F(Served, ABusThatGoesAndComesBackIsHeardAgain) {
  const emulator::ServePlan plan = {.driver = "can", .place = "unix:" + place_, .source = {}};
  auto imu = emulator::serve(plan);
  ASSERT_TRUE(imu) << imu.error().message;
  EXPECT_FALSE(emulator::serve(plan)) << "the place is taken";
  const Session session = open({{"interface", plan.place}, {"preset", "mti600"}}, "can");
  ASSERT_TRUE(session->read_rows(50)) << session->failure();
  imu->reset();
  ASSERT_TRUE(session->read_until([&] { return !session->disconnections().empty(); }));
  imu = emulator::serve(plan);
  ASSERT_TRUE(session->read_rows(100)) << session->failure();
}

TEST_F(Served, ABusWithoutAServerSaysSo) {
  const auto session = RecordingSession::open(
      IMUNOISE_DRIVER_FOLDER, "can", {{"interface", "unix:" + place_}, {"preset", "mti600"}});
  ASSERT_FALSE(session);
  EXPECT_NE(session.error().message.find("is imunoise emulate running?"), std::string::npos);
  const auto mti =
      RecordingSession::open(IMUNOISE_DRIVER_FOLDER, "xsens", {{"port", "pty:" + place_}});
  ASSERT_FALSE(mti);
  EXPECT_NE(mti.error().message.find("is imunoise emulate running?"), std::string::npos);
}

TEST_F(Served, WhatCannotBeServedSaysWhereItCanBeEmulated) {
  const auto adis = emulator::serve({.driver = "adis16405", .place = place_, .source = {}});
  ASSERT_FALSE(adis);
  EXPECT_NE(adis.error().message.find("emulated device=adis16405"), std::string::npos);
}

}  // namespace
}  // namespace imunoise::testing
