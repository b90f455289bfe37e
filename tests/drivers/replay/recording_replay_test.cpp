// A recording of imunoise as the device that it was recorded from.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "recording/store/recorder/recorder.h"
#include "tests/drivers/recording_session.h"

namespace imunoise::testing {
namespace {

namespace fs = std::filesystem;
using recording::Block;
using Options = std::vector<drivers::OptionText>;

constexpr std::int64_t kBegin = 1'700'000'000'000'000'000;
constexpr std::int64_t kPeriod = 1'000'000;  // ns, of the fast stream

class RecordingReplay : public ::testing::Test {
 protected:
  RecordingReplay()
      : folder_(fs::temp_directory_path() / ("imunoise_rerun_" + std::to_string(getpid()))) {}
  ~RecordingReplay() override { fs::remove_all(folder_); }

  static v1::RecordedDevice device(const std::string& name) {
    v1::RecordedDevice out;
    out.set_name(name);
    out.set_serial("S1");
    (*out.mutable_metadata())["product"] = "IMU";
    v1::RecordedStream& fast = *out.add_streams();
    fast.set_name("imu");
    fast.set_rate_hz(1000.0);
    fast.set_counter_modulus(256);
    v1::RecordedChannel& gyro = *fast.add_channels();
    gyro.set_name("gyro_x");
    gyro.set_dtype("<i2");
    gyro.set_units("deg/s");
    gyro.set_scale_factor(0.05);
    v1::RecordedStream& slow = *out.add_streams();
    slow.set_name("slow");
    slow.set_rate_hz(100.0);
    v1::RecordedChannel& temperature = *slow.add_channels();
    temperature.set_name("temperature");
    temperature.set_dtype("<f8");
    temperature.set_units("K");
    return out;
  }

  // A sample a millisecond, every tenth with a temperature; one is missing before the 3000th.
  void record(std::uint32_t replicate, const std::vector<std::string>& names) const {
    recording::RecordingPlan plan;
    plan.replicate = replicate;
    for (const std::string& name : names) plan.devices.push_back(device(name));
    const auto recorder = recording::Recorder::start(recording::posix_file_system(), folder_, plan);
    ASSERT_TRUE(recorder) << recorder.error().message;
    for (std::size_t d = 0; d < names.size(); ++d) {
      Block fast{0, recording::empty_rows(plan.devices[d].streams(0))};
      Block slow{1, recording::empty_rows(plan.devices[d].streams(1))};
      for (std::int64_t i = 0; i < 6000; ++i) {
        fast.rows.host_time.push_back(kBegin + i * kPeriod);
        fast.rows.counter.push_back(i % 256);
        fast.rows.flags.push_back(i == 3000 ? recording::kLostBefore : i == 7 ? 1U : 0U);
        std::get<std::vector<std::int16_t>>(fast.rows.channels[0])
            .push_back(static_cast<std::int16_t>(i - 3000 + replicate));
        if (i % 10 != 0) continue;
        slow.rows.host_time.push_back(kBegin + i * kPeriod + 1);
        slow.rows.flags.push_back(0);
        std::get<std::vector<double>>(slow.rows.channels[0])
            .push_back(300.0 + static_cast<double>(i) / 7.0);
      }
      fast.rows.received = fast.rows.size();
      slow.rows.received = slow.rows.size();
      ASSERT_TRUE((*recorder)->push(d, fast));
      ASSERT_TRUE((*recorder)->push(d, slow));
    }
    ASSERT_TRUE((*recorder)->close());
  }

  auto open(Options options) const {
    options.push_back({"file", folder_.string()});
    return RecordingSession::open(IMUNOISE_DRIVER_FOLDER, "replay", options);
  }
  void expect_refused(const Options& options, const std::string& words) const {
    const auto session = open(options);
    ASSERT_FALSE(session) << words;
    EXPECT_NE(session.error().message.find(words), std::string::npos) << session.error().message;
  }

  fs::path folder_;
};

TEST_F(RecordingReplay, EveryStreamIsDeliveredAsItWasStored) {
  record(1, {"imu0"});
  const auto session = open({{"speed", "0"}});
  ASSERT_TRUE(session) << session.error().message;
  const drivers::DeviceInfo& info = (*session)->info();
  EXPECT_EQ(info.product, "IMU");
  EXPECT_EQ(info.serial, "S1");
  ASSERT_EQ(info.streams.size(), 2U);
  EXPECT_EQ(info.streams[0].counter_maximum, 255U);
  EXPECT_EQ(info.streams[0].channels[0].type, drivers::NumberType::kInt16);
  EXPECT_EQ(info.streams[0].channels[0].scale_factor, 0.05);
  EXPECT_EQ(info.streams[1].nominal_rate_hz, 100.0);
  ASSERT_TRUE((*session)->read_rows(6000));
  ASSERT_TRUE((*session)->read_rows(600, 1));
  const auto& fast = (*session)->rows(0);
  const auto& slow = (*session)->rows(1);
  for (std::size_t i = 0; i < 6000; ++i) {
    ASSERT_EQ(fast[i].numbers[0], static_cast<double>(i) - 2999.0) << i;
    ASSERT_EQ(fast[i].counter, i % 256);
    ASSERT_EQ(fast[i].host_time_ns - fast[0].host_time_ns, static_cast<std::int64_t>(i) * kPeriod);
    std::uint32_t flags = i == 7 ? std::uint32_t{IMUNOISE_SAMPLE_SATURATED} : 0U;
    if (i == 3000) flags = IMUNOISE_SAMPLE_AFTER_GAP;
    ASSERT_EQ(fast[i].flags, flags) << i;
  }
  for (std::size_t i = 0; i < 600; ++i) {
    ASSERT_EQ(slow[i].numbers[0], 300.0 + static_cast<double>(10 * i) / 7.0);
    ASSERT_EQ(slow[i].host_time_ns, fast[10 * i].host_time_ns + 1);
  }
}

TEST_F(RecordingReplay, StreamsTakeTurnsInRealTime) {
  record(1, {"imu0"});
  const auto session = open({{"speed", "10"}});
  ASSERT_TRUE(session) << session.error().message;
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE((*session)->read_rows(3000));
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
  EXPECT_GT(passed.count(), 0.28);  // 3 s, ten times as fast
  EXPECT_NEAR(static_cast<double>((*session)->rows(1).size()), 300.0, 15.0);
}

TEST_F(RecordingReplay, EndsWithItsLastSample) {
  record(1, {"imu0"});
  const auto session = open({{"speed", "0"}});
  ASSERT_TRUE(session) << session.error().message;
  drivers::SampleBlock block = (*session)->device().make_block(1000);
  std::size_t rows = 0;
  for (;;) {
    const auto outcome = (*session)->device().read(std::chrono::milliseconds(100), block);
    ASSERT_TRUE(outcome) << outcome.error().message;
    if (*outcome == drivers::ReadOutcome::kEnd) break;
    rows += block.rows();
  }
  EXPECT_EQ(rows, 6600U);
}

TEST_F(RecordingReplay, ReplicatesAndDevicesAreChosen) {
  record(1, {"imu0", "imu1"});
  record(2, {"imu0", "imu1"});
  const auto session = open({{"speed", "0"}, {"device", "imu1"}, {"replicate", "2"}});
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_TRUE((*session)->read_rows(1));
  EXPECT_EQ((*session)->rows()[0].numbers[0], -2998.0);
  expect_refused({}, "holds the devices imu0, imu1; choose one with device=NAME");
  expect_refused({{"device", "imu7"}}, "no device 'imu7' in replicate 1");
  expect_refused({{"device", "imu0"}, {"replicate", "3"}}, "the replicates 1, 2");
  expect_refused({{"device", "imu0"}, {"rate", "5"}}, "rate: a recording of imunoise is replayed");
}

TEST_F(RecordingReplay, DamageIsRefused) {
  record(1, {"imu0"});
  const fs::path chunk = folder_ / "replicate-1/imu0/000001.h5";
  ASSERT_TRUE(fs::exists(chunk));
  fs::resize_file(chunk, fs::file_size(chunk) / 2);
  expect_refused({}, "000001.h5");
}

TEST_F(RecordingReplay, AFolderWithoutARecordingIsNone) {
  fs::create_directories(folder_);
  expect_refused({}, "no recording of imunoise");
}

}  // namespace
}  // namespace imunoise::testing
