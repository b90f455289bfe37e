// The six static replicates of an ADIS16405.

#include <gtest/gtest.h>

#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

TEST(RealData, SixReplicatesOfAnAdis16405) {
  const std::filesystem::path folder =
      std::filesystem::path(IMUNOISE_SHARED_DIR) / "data/adis16405";
  if (!std::filesystem::exists(folder)) {
    GTEST_SKIP() << "NOT TESTED ON REAL DATA: " << folder << " is not there";
  }
  std::vector<std::filesystem::path> paths;
  for (int i = 1; i <= 6; ++i) {
    paths.push_back(folder / ("replicate" + std::to_string(i) + "_gyro.h5"));
  }
  ImportOptions options;
  options.channels = {"gyro_z", "gyro_x"};
  options.use_disturbed = true;  // a second of the fourth replicate
  const auto got = import_files(paths, options);
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->size(), 6U);
  for (const Replicate& run : *got) {
    EXPECT_EQ(run.rate.value, 100.0);
    ASSERT_EQ(run.channels.size(), 2U);
    EXPECT_EQ(run.channels[0].name, "gyro_z");
    EXPECT_EQ(run.channels[0].signal().size(), 1000000U);
    EXPECT_EQ(run.channels[0].unit.symbol, "deg/s");
    EXPECT_TRUE(std::holds_alternative<std::vector<std::int16_t>>(*run.channels[0].samples));
  }
  // First and last counts of replicate 1, read with h5py: gyro_z 14, 9, -11 ... -9; gyro_x -1
  // ... 7.
  constexpr double per_count = 0.05 * 0.017453292519943295;  // rad/s
  const Signal z = got->front().channels[0].signal();
  const Signal x = got->front().channels[1].signal();
  EXPECT_DOUBLE_EQ(z.value(0), 14 * per_count);
  EXPECT_DOUBLE_EQ(z.value(1), 9 * per_count);
  EXPECT_DOUBLE_EQ(z.value(2), -11 * per_count);
  EXPECT_DOUBLE_EQ(z.value(999999), -9 * per_count);
  EXPECT_DOUBLE_EQ(x.value(0), -1 * per_count);
  EXPECT_DOUBLE_EQ(x.value(999999), 7 * per_count);
}

}  // namespace
}  // namespace imunoise::recording
