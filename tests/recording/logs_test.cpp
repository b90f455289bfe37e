// Logs of PX4, of a CAN bus, of an Xsens device.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>

#include "recording/import/table/streams.h"
#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

std::string told(const Replicate& one) {
  std::string out;
  for (const std::string& said : one.preflight->recognised) out += said + "\n";
  for (const Finding& found : one.preflight->findings) out += found.text + "\n";
  return out;
}

class Ulog : public FileTest {
 protected:
  std::string written(const std::string& kind) const {
    const std::string file = path(kind + ".ulg").string();
    const std::string command = "/usr/bin/python3 " IMUNOISE_SOURCE_DIR
                                "/tests/recording/write_ulog.py " +
                                kind + " " + file;
    return std::system(command.c_str()) == 0 ? file : "";
  }
};

void expect_ulog(const Replicate& one, std::size_t samples, double tolerance = 0.0) {
  EXPECT_DOUBLE_EQ(one.rate.value, 800.0);
  ASSERT_EQ(one.channels.size(), 6U);
  EXPECT_EQ(one.channels[0].name, "gyro_x");
  EXPECT_EQ(one.channels[5].name, "acc_z");
  ASSERT_EQ(one.channels[0].count, samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const double expected = static_cast<double>(i) / 2.0;
    ASSERT_NEAR(stored_doubles(one.channels[0])[i], expected, tolerance * (1.0 + expected));
    ASSERT_NEAR(stored_doubles(one.channels[2])[i], expected + 1.0, tolerance * (1.0 + expected));
    ASSERT_NEAR(stored_doubles(one.channels[5])[i], 10.0, 10.0 * tolerance);
  }
}

TEST_F(Ulog, TheTopicNearestToTheSensorCounts) {
  const auto got = import_one(written("fifo"));
  ASSERT_TRUE(got) << got.error().message;
  expect_ulog(got->front(), 4000);
  expect_parts(told(got->front()), {"topic sensor_gyro_fifo, sensor_accel_fifo", "dropped data 1"});
  ImportOptions second;
  second.topic = "sensor_gyro_fifo/1";
  const auto other = import_one(path("fifo.ulg"), second);
  ASSERT_TRUE(other) << other.error().message;
  ASSERT_EQ(other->front().channels.size(), 3U);
  EXPECT_EQ(stored_doubles(other->front().channels[0])[8], 2.0);
  second.topic = "sensor_mag";
  expect_parts(error_of(path("fifo.ulg"), second), {"sensor_mag", "sensor_gyro_fifo/1"});
}

TEST_F(Ulog, OtherTopicsOfAnImu) {
  const auto combined = import_one(written("combined"));
  ASSERT_TRUE(combined) << combined.error().message;
  expect_ulog(combined->front(), 4000);
  const auto increments = import_one(written("increments"));
  ASSERT_TRUE(increments) << increments.error().message;
  expect_ulog(increments->front(), 4000, 1e-6);
}

TEST_F(Ulog, TopicsOfOneRateAreJoinedAndOthersTold) {
  const auto joined = import_one(written("vectors"));
  ASSERT_TRUE(joined) << joined.error().message;
  ASSERT_EQ(joined->size(), 2U) << "cut where the acceleration misses one";
  EXPECT_EQ((*joined)[0].channels[0].count, 1000U);
  EXPECT_EQ((*joined)[1].channels[0].count, 2999U);
  const auto apart = import_one(written("rates"));
  ASSERT_TRUE(apart) << apart.error().message;
  EXPECT_EQ(apart->front().channels.size(), 3U);
  expect_parts(told(apart->front()), {"sensor_accel (400 Hz) is left out", "--topic sensor_accel"});
  ImportOptions acceleration;
  acceleration.channels = {"acc_z"};
  const auto other = import_one(path("rates.ulg"), acceleration);
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_DOUBLE_EQ(other->front().rate.value, 400.0);
}

TEST_F(Ulog, CutAnywhere) {
  const std::string bytes = bytes_in(written("fifo"));
  std::size_t before = 0;
  for (std::size_t length = 1; length < bytes.size(); length += 1999) {
    const auto got = import_one(write("cut.ulg", bytes.substr(0, length)));
    if (!got) {
      EXPECT_NE(got.error().message.find("cut.ulg: "), std::string::npos);
      EXPECT_EQ(before, 0U) << length << got.error().message;
      continue;
    }
    ASSERT_GE(got->front().channels[0].count, before);
    before = got->front().channels[0].count;
  }
  EXPECT_GT(before, 3900U);
}

class Wire : public FileTest {};

TEST_F(Wire, ALogOfACanBusNeedsItsDatabase) {
  const std::string dbc =
      "VERSION \"\"\nBU_: imu\n"
      "BO_ 291 Rates: 6 imu\n"
      " SG_ GyroX : 0|16@1- (0.001,0) [-32|32] \"rad/s\" host\n"
      " SG_ GyroY : 16|16@1- (0.001,0) [-32|32] \"rad/s\" host\n"
      "BO_ 292 Accelerations: 4 imu\n"
      " SG_ AccZ : 0|16@1- (0.001,0) [-32|32] \"m/s^2\" host\n";
  std::string log;
  for (int i = 0; i < 1000; ++i) {
    const double time = 1700000000.0 + 0.01 * i;
    log += fmt::format("({:.6f}) can0 123#{:02X}{:02X}0100FFFF\n", time, i & 0xff, i >> 8);
    if (i != 500) log += fmt::format("({:.6f}) can0 124#4C260000\n", time + 0.001);
  }
  const auto file = write("bus.log", log);
  expect_parts(error_of(file), {"bus.log", "--dbc FILE", "mti600"});
  ImportOptions options;
  options.dbc = write("imu.dbc", dbc).string();
  const auto got = import_one(file, options);
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->size(), 2U) << "one acceleration is missing";
  const Replicate& one = got->front();
  EXPECT_DOUBLE_EQ(one.rate.value, 100.0);
  ASSERT_EQ(one.channels.size(), 3U);
  double sum = 0.0;
  for (const Channel& channel : one.channels) {
    if (channel.name == "GyroX") {
      EXPECT_NEAR(stored_doubles(channel)[300], 0.3, 1e-12);
    }
    if (channel.name == "AccZ") {
      EXPECT_NEAR(stored_doubles(channel)[300], 9.804, 1e-12);
    }
    sum += stored_doubles(channel)[300];
  }
  EXPECT_NEAR(sum, 0.3 + 0.001 + 9.804, 1e-12);
  options.dbc = path("none.dbc").string();
  expect_parts(error_of(file, options), {"none.dbc"});
}

TEST_F(Wire, CapturesOfAnXsensDevice) {
  const std::filesystem::path capture =
      std::filesystem::path(IMUNOISE_SOURCE_DIR) / "../shared/captures/xsens/capture1.bin";
  if (!std::filesystem::exists(capture))
    GTEST_SKIP() << capture << " is not here: captures of a real device";
  const auto got = import_one(capture);
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_DOUBLE_EQ(got->front().rate.value, 100.0);
  bool gyro = false;
  for (const Channel& channel : got->front().channels) gyro = gyro || channel.name == "gyro_x";
  EXPECT_TRUE(gyro) << told(got->front());
}

// Blocks of regular times are kept narrow, others wide; all come back.
TEST(Streams, TimesComeBackAsTheyCame) {
  std::vector<std::int64_t> all;
  std::int64_t now = 1'700'000'000'000'000'000;
  for (std::int64_t i = 0; i < 300'000; ++i) {
    now += 5'000'000 + (i * 7919) % 400'000 - 200'000;
    if (i == 150'000) now += 10'000'000'000'000;
    if (i == 250'000) now = std::numeric_limits<std::int64_t>::min();
    if (i == 250'001) now = std::numeric_limits<std::int64_t>::max() - 1'000'000'000'000;
    all.push_back(now);
  }
  Times times;
  for (const std::int64_t one : all) times.push(one);
  ASSERT_EQ(times.size(), all.size());
  for (std::size_t i = 0; i < all.size(); i += 7) ASSERT_EQ(times[i], all[i]) << i;
  EXPECT_EQ(times.take(), all);
  EXPECT_TRUE(times.empty());
}

// Two streams whose samples come at a phase of half a step, with jitter: the delay tells pairs.
TEST(Streams, AreJoinedAtTheirUsualDelay) {
  TimedStream first{"a", {}, {}};
  TimedStream second{"b", {}, {}};
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < 500; ++i) {
    const std::int64_t jitter = (i * 7919) % 400'000 - 200'000;
    first.times.push(10'000'000LL * i);
    x.push_back(i);
    if (i % 50 == 7) continue;
    second.times.push(10'000'000LL * i + 4'900'000 + jitter);
    y.push_back(i);
  }
  first.columns = {{"gyro_x", x, 1.0, 0.0, "rad/s"}};
  second.columns = {{"acc_x", y, 1.0, 0.0, "m/s^2"}};
  const auto table = join_streams("f", {second, first}, "t", {});
  ASSERT_TRUE(table) << table.error().message;
  ASSERT_EQ(table->columns.size(), 2U);
  EXPECT_EQ(table->columns[0].name, "gyro_x");
  const auto& joined = std::get<std::vector<double>>(table->columns[1].samples);
  for (int i = 0; i < 500; ++i) {
    const double there = joined[static_cast<std::size_t>(i)];
    if (i % 50 == 7) {
      EXPECT_TRUE(std::isnan(there)) << i;
    } else {
      EXPECT_EQ(there, i);
    }
  }
}

}  // namespace
}  // namespace imunoise::recording
