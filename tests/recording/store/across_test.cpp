// Several devices of one recording as one array. Each channel tells the host's time at which it was
// sampled, so that what stands side by side can be seen.

#include "recording/store/reading/across.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "recording/store/recorder/recorder.h"
#include "tests/recording/files.h"
#include "tests/recording/simulated_bench.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

using imunoise::testing::BenchDevice;

// Seconds since the replicate began, as rad/s.
BenchDevice teller(const std::string& name, std::size_t samples, double rate_hz = 100.0) {
  BenchDevice out;
  out.name = name;
  out.rate_hz = rate_hz;
  out.samples = samples;
  out.channels = {{"gyro_x", "rad/s", [](std::size_t, double t) { return t; }}};
  return out;
}

std::string gyro_of(const BenchDevice& device) { return device.name + "/imu/gyro_x"; }

class AcrossDevices : public FileTest {
 protected:
  // Of the rate that most devices have.
  Across joined(const std::vector<BenchDevice>& devices) {
    record(1, devices);
    return read(devices);
  }
  void record(std::uint32_t replicate, const std::vector<BenchDevice>& devices) {
    imunoise::testing::record_bench(path("run"), replicate, kStart, devices);
  }
  Across read(const std::vector<BenchDevice>& devices) { return read_all(devices).front(); }
  std::vector<Across> read_all(const std::vector<BenchDevice>& devices) {
    std::vector<std::string> channels;
    for (const BenchDevice& device : devices) channels.push_back(gyro_of(device));
    auto out = import_across(posix_file_system(), path("run"), channels);
    EXPECT_TRUE(out) << out.error().message;
    return out.value_or(std::vector<Across>(1));
  }
};

std::string reason_of(const Across& across, const std::string& device) {
  for (const LeftOut& one : across.left_out) {
    if (one.device == device) return one.reason;
  }
  return "is joined";
}

// The largest difference of what two channels tell, s.
double apart(const Replicate& replicate, std::size_t a, std::size_t b) {
  const Signal first = replicate.channels[a].signal();
  const Signal second = replicate.channels[b].signal();
  EXPECT_EQ(first.size(), second.size());
  double out = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i)
    out = std::max(out, std::abs(first.value(i) - second.value(i)));
  return out;
}

TEST_F(AcrossDevices, StandSideBySideInHostTime) {
  BenchDevice late = teller("b", 10'000);
  late.after_s = 3.2171;
  late.ppm = 200.0;  // half a sample in 25 s
  late.late_s = 5e-4;
  const Across got = joined({teller("a", 10'000), late, teller("c", 10'000)});
  EXPECT_TRUE(got.left_out.empty());
  ASSERT_EQ(got.replicates.size(), 1U);
  const Replicate& run = got.replicates[0];
  EXPECT_EQ(run.name, "replicate-1");
  EXPECT_EQ(run.rate.value, 100.0);
  ASSERT_EQ(run.channels.size(), 3U);
  EXPECT_EQ(run.channels[1].name, "b/imu/gyro_x");
  EXPECT_EQ(run.channels[1].unit.quantity, Quantity::kAngularRate);
  EXPECT_EQ(run.channels[0].count, run.channels[1].count);
  // 96.78 s in common; ends may cost a sample each.
  EXPECT_NEAR(static_cast<double>(run.channels[0].count), 9678.0, 2.0);
  EXPECT_NEAR(got.seconds, 96.78, 0.03);
  // Half a sample, and what the earliest of a hundred delays of 0.5 ms leaves: 5 µs, and the line
  // through these as much again at its ends.
  EXPECT_LT(apart(run, 0, 1), 0.005 + 5e-5);
  EXPECT_LT(apart(run, 0, 2), 1e-6);
  ASSERT_EQ(got.streams.size(), 3U);
  EXPECT_NEAR(got.streams[1].clock_ppm, 200.0, 1.0);
  // 200e-6 of 9678.
  EXPECT_NEAR(static_cast<double>(got.streams[1].dropped), 1.94, 1.0);
  EXPECT_EQ(got.streams[0].dropped, 0U);
  EXPECT_NEAR(got.streams[0].seconds, 100.0, 1e-3);
}

// Four samples at 400 Hz lie about their mean's time: 0.5, 1.5, 2.5 and 3.5 quarters.
TEST_F(AcrossDevices, OfAWholeRatioOfRatesAreAveraged) {
  BenchDevice fast = teller("fast", 24'000, 400.0);
  fast.after_s = 0.0011;
  const Across got = joined({teller("slow", 6000), fast});
  EXPECT_TRUE(got.left_out.empty());
  ASSERT_EQ(got.replicates.size(), 1U);
  EXPECT_EQ(got.replicates[0].rate.value, 100.0);
  EXPECT_EQ(got.streams[1].averaged, 4U);
  EXPECT_EQ(got.streams[1].rate.value, 400.0);
  EXPECT_LE(apart(got.replicates[0], 0, 1), 0.00125 + 1e-6) << "half a sample of the faster";
  EXPECT_GE(got.replicates[0].channels[0].count, 5998U);
}

TEST_F(AcrossDevices, OfRatesWithoutAWholeRatioAreNotJoined) {
  const std::vector<BenchDevice> two{teller("a", 6000), teller("b", 6144, 102.4)};
  const Across got = joined(two);
  EXPECT_TRUE(got.replicates.empty());
  EXPECT_EQ(reason_of(got, "a"),
            "not joined: rates differ: 100 Hz and 102.4 Hz have no whole ratio");
}

TEST_F(AcrossDevices, TheRateIsThatOfMostDevices) {
  const Across got = joined({teller("odd", 6144, 102.4), teller("a", 6000), teller("b", 6000)});
  ASSERT_EQ(got.replicates.size(), 1U);
  EXPECT_EQ(got.replicates[0].channels.size(), 2U);
  EXPECT_EQ(got.streams[0].device, "a");
  EXPECT_EQ(reason_of(got, "odd"),
            "not joined: rates differ: 102.4 Hz and 100 Hz have no whole ratio");
}

TEST_F(AcrossDevices, EachRateOfSeveralHasItsOwn) {
  const std::vector<BenchDevice> all{teller("a", 6000), teller("b", 6144, 102.4), teller("c", 6000),
                                     teller("d", 6144, 102.4), teller("e", 3000, 50.1)};
  record(1, all);
  const std::vector<Across> got = read_all(all);
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(got[0].channels, (std::vector<std::string>{"b/imu/gyro_x", "d/imu/gyro_x"}));
  EXPECT_EQ(got[0].replicates.at(0).rate.value, 102.4);
  EXPECT_EQ(got[0].left_out.size(), 3U);
  EXPECT_EQ(got[1].channels, (std::vector<std::string>{"a/imu/gyro_x", "c/imu/gyro_x"}));
  EXPECT_EQ(got[1].replicates.at(0).rate.value, 100.0);
  EXPECT_TRUE(got[1].left_out.empty());
}

TEST_F(AcrossDevices, ThatNeverRanTogetherAreNotJoined) {
  BenchDevice later = teller("b", 3000);
  later.after_s = 40.5;
  const Across got = joined({teller("a", 4000), later});
  EXPECT_TRUE(got.replicates.empty());
  EXPECT_EQ(reason_of(got, "b"), "not joined: it never ran at the same time as a");
}

// Of two, what they share counts. Where others would lose more than half, they go without it.
TEST_F(AcrossDevices, ThatStoppedEarlyDoNotCostTheOthersTheirTime) {
  const std::vector<BenchDevice> pair{teller("a", 12'000), teller("brief", 3000)};
  const Across two = joined(pair);
  ASSERT_EQ(two.replicates.size(), 1U);
  EXPECT_EQ(two.replicates[0].channels[0].count, 3000U);
  EXPECT_EQ(two.replicates[0].channels[1].count, 3000U);
  EXPECT_NEAR(two.streams[0].seconds, 120.0, 1e-3);
  EXPECT_NEAR(two.seconds, 30.0, 1e-3);

  std::filesystem::remove_all(path("run"));
  const Across three = joined({teller("a", 12'000), teller("brief", 3000), teller("c", 11'000)});
  ASSERT_EQ(three.replicates.size(), 1U);
  EXPECT_EQ(three.replicates[0].channels.size(), 2U);
  EXPECT_EQ(three.replicates[0].channels[0].count, 11'000U);
  EXPECT_EQ(reason_of(three, "brief"),
            "not joined: it shares only 30 s of the 110 s that the others have together");
}

TEST_F(AcrossDevices, ReplicatesOfNearlyOneLengthAreCutToIt) {
  BenchDevice a = teller("a", 6000);
  BenchDevice b = teller("b", 6000);
  record(1, {a, b});
  b.after_s = 0.3;
  record(2, {a, b});
  b.samples = 3000;
  record(3, {a, b});
  record(4, {a});
  const Across got = read({a, b});
  ASSERT_EQ(got.replicates.size(), 3U) << "the fourth lacks b";
  EXPECT_EQ(got.replicates[0].channels[0].count, 5970U);
  EXPECT_EQ(got.replicates[1].channels[0].count, 5970U);
  EXPECT_EQ(got.replicates[2].channels[1].count, 3000U);
  EXPECT_LT(apart(got.replicates[1], 0, 1), 1e-6);
}

TEST_F(AcrossDevices, WithAWildClockOrADamagedChunkAreLeftOut) {
  BenchDevice wild = teller("wild", 6000);
  wild.ppm = 50'000;
  const std::vector<BenchDevice> all{teller("a", 6000), teller("b", 6000), wild,
                                     teller("torn", 6000), teller("short", 900)};
  record(1, all);
  write("run/replicate-1/torn/000001.h5", "no chunk");
  const Across got = read(all);
  ASSERT_EQ(got.replicates.size(), 1U);
  EXPECT_EQ(got.replicates[0].channels.size(), 2U);
  EXPECT_EQ(reason_of(got, "wild"),
            "not joined: it samples 5.0 % faster than its nominal rate, by the host's clock");
  EXPECT_NE(reason_of(got, "torn").find("000001.h5"), std::string::npos);
  EXPECT_EQ(reason_of(got, "short"), "not joined: no stretch without a gap has ten seconds");
}

TEST_F(AcrossDevices, NeedTwoDevicesOfARecording) {
  const std::vector<BenchDevice> one{teller("a", 2000), teller("b", 2000)};
  record(1, one);
  const auto error = [&](const std::string& folder, const std::vector<std::string>& channels) {
    const auto got = import_across(posix_file_system(), path(folder), channels);
    return got ? "no error" : got.error().message;
  };
  EXPECT_NE(error("run", {"a/imu/gyro_x"}).find("two devices"), std::string::npos);
  EXPECT_NE(error("run", {"a/imu/gyro_x", "b/imu/gyro_w"}).find("gyro_w"), std::string::npos);
  EXPECT_NE(error("run/replicate-1", {"a/imu/gyro_x"}).find("manifest.json"), std::string::npos);
}

// Counts that need no thinning stay what the file holds.
TEST_F(AcrossDevices, KeepCountsAndScales) {
  RecordingPlan plan;
  plan.devices = {test_device("a"), test_device("b")};
  const auto recorder = Recorder::start(posix_file_system(), path("run"), plan);
  ASSERT_TRUE(recorder) << recorder.error().message;
  for (std::size_t device = 0; device < 2; ++device)
    ASSERT_TRUE((*recorder)->push(device, imu_block(0, 2000)));
  ASSERT_TRUE((*recorder)->close());
  const auto got =
      import_across(posix_file_system(), path("run"), {"a/imu/gyro_x", "b/imu/gyro_x"});
  ASSERT_TRUE(got) << got.error().message;
  const Channel& x = got->at(0).replicates.at(0).channels.at(1);
  EXPECT_TRUE(std::holds_alternative<std::vector<std::int16_t>>(*x.samples));
  EXPECT_DOUBLE_EQ(x.signal().value(3), (3 * 7 - 1000) * 0.05 * std::acos(-1.0) / 180.0);
}

}  // namespace
}  // namespace imunoise::recording
