// Recorded files as a device, through the plugin.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "drivers/host/device.h"
#include "drivers/host/load.h"
#include "recording/export/write_samples.h"
#include "recording/import/import.h"
#include "tests/support/golden.h"

namespace imunoise {
namespace {

using namespace std::chrono_literals;
using drivers::Device;
using drivers::NumberType;
using drivers::OptionText;
using drivers::ReadOutcome;
using drivers::SampleBlock;
namespace fs = std::filesystem;

class Replay : public ::testing::Test {
 protected:
  Replay() : folder_(fs::temp_directory_path() / ("imunoise_replay_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~Replay() override { fs::remove_all(folder_); }

  static Result<std::unique_ptr<Device>> open(const std::vector<OptionText>& options) {
    static const drivers::Drivers kDrivers = drivers::load_drivers({IMUNOISE_DRIVER_FOLDER});
    const auto driver = kDrivers.find("replay");
    if (!driver) return tl::make_unexpected(driver.error());
    return Device::open(**driver, options);
  }

  // A file of two channels whose numbers tell file, channel and row.
  fs::path write(const std::string& name, double mark, std::size_t rows = 5000) const {
    std::vector<double> x(rows);
    std::vector<double> y(rows);
    for (std::size_t i = 0; i < rows; ++i) {
      x[i] = mark + static_cast<double>(i) / 3.0;
      y[i] = -x[i];
    }
    const Unit unit = *parse_unit("deg/s");
    const recording::OutputChannel channels[] = {{"x", x, unit}, {"y", y, unit}};
    EXPECT_TRUE(recording::write_samples(folder_ / name, channels, Hertz{200.0}, {}));
    return folder_ / name;
  }

  // Raw counts of two channels with a sidecar.
  fs::path write_counts(const std::string& name, std::size_t rows) const {
    std::ofstream file(folder_ / name, std::ios::binary);
    for (std::size_t i = 0; i < rows; ++i) {
      const std::int16_t numbers[] = {static_cast<std::int16_t>(i % 30000),
                                      static_cast<std::int16_t>(-7)};
      file.write(static_cast<const char*>(static_cast<const void*>(numbers)), sizeof numbers);
    }
    std::ofstream(folder_ / (name + ".json"))
        << R"({"rate_hz": 819.2, "dtype": "<i2", "channels": [)"
        << R"({"name": "a/x", "units": "mg", "scale_factor": 3.33},)"
        << R"({"name": "t", "units": "degC", "scale_factor": 0.14, "add_offset": 25}]})";
    return folder_ / name;
  }

  fs::path folder_;
};

// Reads to the end and compares every number and every stamp with what import_files says.
void expect_replayed(Device& device, const std::vector<recording::Replicate>& expected) {
  SampleBlock block = device.make_block(777);
  std::size_t replicate = 0;
  std::size_t row = 0;
  std::size_t total = 0;
  std::int64_t first_ns = 0;
  const double rate = expected.front().rate.value;
  for (;;) {
    const auto outcome = device.read(10s, block);
    ASSERT_TRUE(outcome) << outcome.error().message;
    if (*outcome == ReadOutcome::kEnd) break;
    ASSERT_EQ(*outcome, ReadOutcome::kSamples);
    for (std::size_t i = 0; i < block.rows(); ++i, ++row, ++total) {
      ASSERT_LT(replicate, expected.size());
      if (row == expected[replicate].channels[0].count) {
        ++replicate;
        row = 0;
      }
      if (total == 0) first_ns = block.host_time_ns()[0];
      ASSERT_EQ(block.counter()[i], row);
      ASSERT_EQ(block.flags()[i], row == 0 ? std::uint32_t{IMUNOISE_SAMPLE_AFTER_RESTART} : 0U);
      ASSERT_EQ(block.device_time_ns()[i], std::llround(static_cast<double>(row) / rate * 1e9));
      ASSERT_EQ(block.host_time_ns()[i] - first_ns,
                std::llround(static_cast<double>(total) / rate * 1e9));
      for (std::size_t c = 0; c < block.stream().channels.size(); ++c) {
        const recording::Channel& channel = expected[replicate].channels[c];
        std::visit(
            [&]<class Number>(const std::vector<Number>& stored) {
              ASSERT_EQ(block.column<Number>(c)[i], stored[channel.begin + row]);
            },
            *channel.samples);
        ASSERT_EQ(block.stream().channels[c].scale_factor, channel.scale);
        ASSERT_EQ(block.stream().channels[c].add_offset, channel.offset);
      }
    }
  }
  EXPECT_EQ(replicate + 1, expected.size());
  EXPECT_EQ(row, expected.back().channels[0].count);
}

TEST_F(Replay, EverySampleOfEveryFormatInOrder) {
  const std::vector<fs::path> files = {write("b.h5", 1e4), write("a.csv", 2e4),
                                       write("c.npy", 3e4)};
  std::vector<OptionText> options = {{"speed", "0"}};
  for (const fs::path& file : files) options.push_back({"file", file.string()});
  const auto device = open(options);
  ASSERT_TRUE(device) << device.error().message;
  ASSERT_EQ((*device)->info().streams.size(), 1U);
  const drivers::Stream& stream = (*device)->info().streams[0];
  EXPECT_EQ(stream.nominal_rate_hz, 200.0);
  ASSERT_EQ(stream.channels.size(), 2U);
  EXPECT_EQ(stream.channels[0].name, "x");
  EXPECT_EQ(stream.channels[0].units, "rad/s");
  EXPECT_EQ(stream.channels[0].type, NumberType::kFloat64);
  const auto expected = recording::import_files(files);
  ASSERT_TRUE(expected) << expected.error().message;
  expect_replayed(**device, *expected);
}

TEST_F(Replay, CountsStayCounts) {
  const std::vector<fs::path> files = {write_counts("run.i16", 20001)};
  const auto device = open({{"file", files[0].string()}, {"speed", "0"}, {"split_into", "4"}});
  ASSERT_TRUE(device) << device.error().message;
  const drivers::Stream& stream = (*device)->info().streams[0];
  EXPECT_EQ(stream.nominal_rate_hz, 819.2);
  EXPECT_EQ(stream.channels[0].name, "a_x");
  EXPECT_EQ(stream.channels[0].type, NumberType::kInt16);
  EXPECT_EQ(stream.channels[0].units, "m/s^2");
  EXPECT_NEAR(stream.channels[0].scale_factor, 3.33 * 9.80665e-3, 1e-15);
  EXPECT_EQ(stream.channels[1].units, "K");
  EXPECT_NEAR(stream.channels[1].add_offset, 298.15, 1e-12);
  recording::ImportOptions import;
  import.split_into = 4;
  const auto expected = recording::import_files(files, import);
  ASSERT_TRUE(expected);
  expect_replayed(**device, *expected);
}

TEST_F(Replay, RealRecordingsComeBackAsTheyAre) {
  IMUNOISE_NEEDS("data/adis16405/replicate1_gyro.h5");
  std::vector<fs::path> files;
  std::vector<OptionText> options = {{"speed", "0"}};
  for (const int k : {1, 2}) {
    files.push_back(testing::shared("data/adis16405") /
                    ("replicate" + std::to_string(k) + "_gyro.h5"));
    options.push_back({"file", files.back().string()});
  }
  const auto device = open(options);
  ASSERT_TRUE(device) << device.error().message;
  expect_replayed(**device, *recording::import_files(files));
}

TEST_F(Replay, KeepsTheTimeOfTheRecordingTimesTheSpeed) {
  const fs::path file = write("run.npy", 0.0, 400);  // 2 s at 200 Hz
  const auto device = open({{"file", file.string()}, {"speed", "10"}});
  ASSERT_TRUE(device) << device.error().message;
  SampleBlock block = (*device)->make_block(1000);
  const auto start = std::chrono::steady_clock::now();
  std::size_t rows = 0;
  std::size_t reads = 0;
  while (*(*device)->read(10s, block) == ReadOutcome::kSamples) {
    rows += block.rows();
    ++reads;
    // Never early: the device's clock began before ours.
    const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - start;
    EXPECT_LE(static_cast<double>(rows), (gone.count() + 1.0) * 10.0 * 200.0);
  }
  const auto took = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(rows, 400U);
  EXPECT_GE(took, 150ms);  // 0.2 s less what passed between open and start
  EXPECT_LT(took, 20s);    // on a machine that is busy with other things
  EXPECT_GE(reads, 2U);    // groups of 0.01 s, 20 samples, fewer and larger where late
}

TEST_F(Replay, TimesOutBetweenSamples) {
  const fs::path file = write("run.npy", 0.0, 16);
  const auto device = open({{"file", file.string()}, {"speed", "0.001"}});  // a sample in 5 s
  ASSERT_TRUE(device) << device.error().message;
  SampleBlock block = (*device)->make_block(10);
  EXPECT_EQ(*(*device)->read(0ms, block), ReadOutcome::kTimeout);
  EXPECT_EQ(*(*device)->read(5ms, block), ReadOutcome::kTimeout);
}

TEST_F(Replay, CancelFromAnotherThreadEndsAWait) {
  const fs::path file = write("run.npy", 0.0, 16);
  const auto device = open({{"file", file.string()}, {"speed", "1e-6"}});  // a sample in 83 min
  ASSERT_TRUE(device) << device.error().message;
  SampleBlock block = (*device)->make_block(10);
  std::jthread canceller([&] {
    std::this_thread::sleep_for(20ms);
    (*device)->cancel();
  });
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(*(*device)->read(1h, block), ReadOutcome::kCancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 30s);
  EXPECT_EQ(*(*device)->read(1h, block), ReadOutcome::kCancelled);
}

TEST_F(Replay, ManyDevicesAtOnce) {
  const fs::path file = write("run.npy", 5.0);
  const auto expected = recording::import_files(std::vector<fs::path>{file});
  std::vector<std::jthread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      const auto device = open({{"file", file.string()}, {"speed", "0"}});
      ASSERT_TRUE(device) << device.error().message;
      expect_replayed(**device, *expected);
    });
  }
}

TEST_F(Replay, SaysWhatIsWrongWithTheFiles) {
  EXPECT_NE(open({}).error().message.find("option file is missing"), std::string::npos);
  const auto missing = open({{"file", (folder_ / "none.h5").string()}});
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("none.h5"), std::string::npos) << missing.error().message;
  const auto unit = open({{"file", write("a.npy", 1.0).string()}, {"unit", "furlong"}});
  ASSERT_FALSE(unit);
  EXPECT_NE(unit.error().message.find("furlong"), std::string::npos) << unit.error().message;
}

}  // namespace
}  // namespace imunoise
