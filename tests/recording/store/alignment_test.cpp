// Channels of a device's other streams, at the times of the one under study.

#include "recording/store/timeline/alignment.h"

#include <gtest/gtest.h>

#include "recording/store/reading/replicates.h"
#include "recording/store/recorder/recorder.h"
#include "tests/recording/files.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

TEST(AtTimes, LieOnTheLineBetweenRows) {
  const std::vector<std::int64_t> times{100, 200, 400};
  const std::vector<std::int64_t> wanted{50, 100, 150, 200, 300, 350, 400, 500};
  const Numbers numbers = std::vector<std::int16_t>{10, 20, -20};
  EXPECT_EQ(at_times(numbers, times, wanted),
            (std::vector<double>{10, 10, 15, 20, 0, -10, -20, -20}));
}

TEST(AtTimes, AreZeroWhereNothingCame) {
  EXPECT_EQ(at_times(Numbers(std::vector<float>()), {}, std::vector<std::int64_t>{1, 2}),
            (std::vector<double>{0, 0}));
}

class OtherStreams : public FileTest {
 protected:
  // Three seconds of a device whose slow stream, and the channel in the same one, have these units,
  // read beside its gyroscope.
  Result<std::vector<Replicate>> beside_gyro(const std::string& slow_units,
                                             const std::string& row_units = "") const {
    const std::filesystem::path root = path("run");
    RecordingPlan plan;
    plan.devices = {test_device()};
    plan.devices[0].mutable_streams(1)->mutable_channels(0)->set_units(slow_units);
    plan.devices[0].mutable_streams(0)->mutable_channels(1)->set_units(row_units);
    const auto recorder = Recorder::start(posix_file_system(), root, plan);
    if (!recorder) return tl::unexpected(recorder.error());
    for (int i = 0; i < 4; ++i) EXPECT_TRUE((*recorder)->push(0, slow_block(i)));
    EXPECT_TRUE((*recorder)->push(0, imu_block(0, 300)));
    EXPECT_TRUE((*recorder)->close());
    ImportOptions options;
    options.channels = {"imu0/imu/gyro_x"};
    options.beside = true;
    return import_recording(posix_file_system(), root, options);
  }
};

TEST_F(OtherStreams, OfTicksAreLeftOut) {
  const auto read = beside_gyro("ticks");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->front().channels.size(), 2U);
}

TEST_F(OtherStreams, OfTicksInTheSameStreamAreLeftOut) {
  const auto read = beside_gyro("ticks", "ticks");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->front().channels.size(), 1U);
  EXPECT_EQ(read->front().channels[0].name, "imu0/imu/gyro_x");
}

TEST_F(OtherStreams, AreReadBesideTheOneUnderStudy) {
  const auto read = beside_gyro("K");
  ASSERT_TRUE(read) << read.error().message;
  const std::vector<Channel>& channels = read->front().channels;
  ASSERT_EQ(channels.size(), 3U);
  EXPECT_EQ(channels[0].name, "imu0/imu/gyro_x");
  EXPECT_EQ(channels[1].name, "imu0/imu/row");
  EXPECT_EQ(channels[2].name, "imu0/slow/temperature");
  EXPECT_FALSE(channels[1].interpolated);
  EXPECT_TRUE(channels[2].interpolated);
  // A degree a second, seen every hundredth of one.
  ASSERT_EQ(channels[2].count, 300U);
  const Signal temperature = channels[2].signal();
  EXPECT_DOUBLE_EQ(temperature.value(0), 0.0);
  EXPECT_DOUBLE_EQ(temperature.value(150), 1.5);
  EXPECT_EQ(temperature.rate().value, 100.0);
}

}  // namespace
}  // namespace imunoise::recording
