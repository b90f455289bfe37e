// Arrays across the devices of one recording, which share a simulated disturbance or do not.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/array/array_moments.h"
#include "core/model/model.h"
#include "study/calibration/calibrate.h"
#include "tests/recording/simulated_bench.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::study {
namespace {

using testing::BenchDevice;

constexpr std::uint64_t kSeed = 20261122;
constexpr double kWhite = 1e-8;   // (rad/s)² of each gyro at 100 Hz
constexpr double kWalk = 1e-9;    // (rad/s)² a hundredth of a second, of what disturbs
constexpr double kFine = 1000.0;  // Hz: the disturbance is known at every millisecond
constexpr std::uint32_t kReplicates = 3;

std::vector<double> walk(std::size_t seconds, std::uint64_t stream, std::uint32_t replicate) {
  const std::string text = "RW(gamma2=" + std::to_string(kWalk * 1e9 * 100.0 / kFine) + ")";
  auto out = simulate(parse_model(text, Hertz{kFine}).value(),
                      seconds * static_cast<std::size_t>(kFine), kSeed + stream, replicate);
  for (double& x : out) x *= std::sqrt(1e-9);
  return out;
}

std::vector<double> white(std::size_t samples, double sigma2, std::uint64_t stream,
                          std::uint32_t replicate) {
  auto out = simulate(parse_model("WN(sigma2=1)", Hertz{100.0}).value(), samples, kSeed + stream,
                      replicate);
  for (double& x : out) x *= std::sqrt(sigma2);
  return out;
}

// A gyro_x that feels what is common and a gyro_y that feels something of its own. Each has noise
// of kWhite in every hundredth of a second.
struct Bench {
  testing::TemporaryFolder folder;
  recording::FileSystem& files = recording::posix_file_system();

  void record(const std::vector<BenchDevice>& devices) {
    std::printf("seed %llu\n", static_cast<unsigned long long>(kSeed));
    for (std::uint32_t k = 1; k <= kReplicates; ++k) {
      std::vector<BenchDevice> now = devices;
      const std::vector<double> common = walk(300, 1, k);
      for (std::size_t d = 0; d < now.size(); ++d) {
        const double sigma2 = kWhite * now[d].rate_hz / 100.0;
        now[d].channels = {
            gyro("gyro_x", common, white(now[d].samples, sigma2, 10 + d, k)),
            gyro("gyro_y", walk(300, 30 + d, k), white(now[d].samples, sigma2, 20 + d, k))};
      }
      testing::record_bench(folder.path(), k, testing::kSimulatedStart, now);
    }
  }

  v1::Calibration calibrated(const std::vector<std::string>& channels = {}) {
    CalibrateOptions options;
    options.models = {"WN + RW"};
    options.diagnose = false;
    options.array = true;
    options.array_model = "RW[corr] + WN";
    options.bootstrap.sets = 0;
    options.channels = channels;
    auto out = calibrate(files, folder.path(), options);
    EXPECT_TRUE(out) << out.error().message;
    return out.value_or(v1::Calibration());
  }

 private:
  static testing::BenchChannel gyro(const std::string& name, std::vector<double> moved,
                                    std::vector<double> own) {
    return {name, "rad/s",
            [moved = std::move(moved), own = std::move(own)](std::size_t i, double t) {
              return moved[static_cast<std::size_t>(t * kFine)] + own[i];
            }};
  }
};

BenchDevice device(const std::string& name, std::size_t samples, double rate_hz = 100.0) {
  BenchDevice out;
  out.name = name;
  out.rate_hz = rate_hz;
  out.samples = samples;
  return out;
}

// The array of an axis across devices.
const v1::ArrayCalibration& across(const v1::Calibration& calibration, const std::string& axis) {
  for (const v1::ArrayCalibration& one : calibration.arrays()) {
    if (one.device().empty() && one.channels(0).ends_with("/" + axis)) return one;
  }
  ADD_FAILURE() << "no array of " << axis;
  return v1::ArrayCalibration::default_instance();
}

// Two gyros of these powers, whose walks are one or two.
ArrayModel truth_of(bool common) {
  ArrayModel out = expand(parse_array_model("RW[corr] + WN", Hertz{100.0}).value(), {2, {}});
  for (Latent& latent : out.latents) {
    if (latent.matrix()) {
      latent.power = kWalk * Eigen::MatrixXd::Identity(2, 2);
      if (common) latent.power.fill(kWalk);
    } else {
      latent.set_scalar(kWhite);
    }
  }
  return out;
}

// Measured cross-covariances and variances lie about those of the truth as Isserlis' theorem says,
// within 4.5 standard deviations: one of 10,000 sets of 18 numbers does not by chance. Half a
// sample apart, or averaged, a random walk loses up to 0.5/m² of it.
void expect_truth(const v1::ArrayCalibration& array, bool common) {
  ASSERT_TRUE(array.has_report()) << (array.troubles_size() > 0 ? array.troubles(0).message() : "");
  const v1::ArrayReport& report = array.report();
  ASSERT_EQ(report.replicates(), kReplicates);
  ASSERT_EQ(report.rate_hz(), 100.0);
  ASSERT_EQ(report.pairs_size(), 1);
  const ArrayModel truth = truth_of(common);
  const auto samples = static_cast<std::size_t>(array.join().seconds() * 100.0 / kReplicates);
  const Scales scales({1, 2, 4, 8, 16, 32, 64, 128, 256});
  const auto expected = covariance(truth, scales);
  const auto sd_of = [&](const Pair& pair) -> Eigen::ArrayXd {
    return (array_moment_covariance(truth, {pair}, scales, samples).diagonal().array() /
            kReplicates)
        .sqrt();
  };
  const Eigen::ArrayXd cross_sd = sd_of({0, 1});
  const Eigen::ArrayXd own_sd = sd_of({0, 0});
  for (std::size_t j = 0; j < scales.size(); ++j) {
    const v1::CrossScale& prepared = report.pairs(0).scales(static_cast<int>(j));
    const auto m = static_cast<double>(scales[j]);
    const auto at = static_cast<Eigen::Index>(j);
    ASSERT_NEAR(prepared.tau_s(), 2.0 * m / 100.0, 1e-9);
    const double walked = kWalk * (2.0 * m * m + 1.0) / (12.0 * m) * 0.5 / (m * m);
    EXPECT_NEAR(prepared.covariance(), expected[j](0, 1),
                4.5 * cross_sd(at) + (common ? walked : 0.0))
        << "m = " << m;
    EXPECT_NEAR(prepared.unit(), expected[j](0, 0), 4.5 * own_sd(at) + walked) << "m = " << m;
  }
  EXPECT_EQ(report.pairs(0).dependent(), common) << report.pairs(0).p_value();
}

// Of what they share alone: devices that start at different times, run at different rates and stop
// at different times.
TEST(CalibrationAcross, WhatAllDevicesFeelIsSharedAndNothingElse) {
  BenchDevice late = device("b", 15'000);
  late.after_s = 1.7043;
  late.ppm = 2000.0;  // 30 samples in all
  late.late_s = 3e-4;
  Bench bench;
  bench.record({device("a", 16'384), late});
  const v1::Calibration got = bench.calibrated();
  ASSERT_EQ(got.arrays_size(), 4) << "of a, of b, and two axes across";
  EXPECT_EQ(got.arrays(0).device(), "a");
  EXPECT_FALSE(got.arrays(0).has_join());
  EXPECT_EQ(got.arrays(1).device(), "b");

  const v1::ArrayCalibration& x = across(got, "gyro_x");
  ASSERT_EQ(x.channels_size(), 2);
  EXPECT_EQ(x.channels(0), "a/imu/gyro_x");
  EXPECT_EQ(x.channels(1), "b/imu/gyro_x");
  EXPECT_TRUE(x.stream().empty());
  EXPECT_TRUE(x.troubles().empty());
  expect_truth(x, true);
  expect_truth(across(got, "gyro_y"), false);

  // Both are equally noisy beside what they share.
  for (const v1::SensorWeight& one : x.report().virtual_sensor().weights())
    EXPECT_NEAR(one.weight(), 0.5, 4.5 * one.standard_error()) << one.sensor();

  ASSERT_EQ(x.join().streams_size(), 2);
  const v1::JoinedStream& b = x.join().streams(1);
  EXPECT_EQ(b.device(), "b");
  EXPECT_NEAR(b.clock_ppm(), 2000.0, 1.0);
  EXPECT_EQ(b.averaged(), 1U);
  // 15,000 samples of b are 149.7 s; of 3 × 14,970 it leaves 0.2 % out.
  EXPECT_NEAR(x.join().seconds(), 3 * 149.7, 0.1);
  EXPECT_NEAR(static_cast<double>(b.dropped()), 90.0, 3.0);
  EXPECT_EQ(x.join().streams(0).dropped(), 0U);
}

TEST(CalibrationAcross, AFasterDeviceIsAveraged) {
  BenchDevice fast = device("fast", 60'000, 400.0);
  fast.after_s = 0.403;
  fast.ppm = -500.0;
  Bench bench;
  bench.record({fast, device("slow", 16'384)});
  const v1::Calibration got = bench.calibrated();
  const v1::ArrayCalibration& x = across(got, "gyro_x");
  EXPECT_EQ(x.join().streams(0).averaged(), 4U);
  EXPECT_EQ(x.join().streams(0).rate_hz(), 400.0);
  EXPECT_GT(x.join().streams(1).dropped(), 10U) << "its clock is the faster one";
  expect_truth(x, true);
  expect_truth(across(got, "gyro_y"), false);
}

TEST(CalibrationAcross, WhatCannotBeJoinedIsTold) {
  BenchDevice later = device("later", 2000);
  later.after_s = 50.0;
  Bench bench;
  bench.record({device("a", 4096), device("odd", 4096, 102.4), later});
  const v1::Calibration got = bench.calibrated();
  ASSERT_EQ(got.arrays_size(), 5);
  const v1::ArrayCalibration& x = across(got, "gyro_x");
  EXPECT_FALSE(x.has_report());
  EXPECT_FALSE(x.has_join());
  EXPECT_EQ(x.channels_size(), 3);
  ASSERT_EQ(x.troubles_size(), 2);
  EXPECT_EQ(x.troubles(0).step(), "join");
  EXPECT_EQ(x.troubles(0).message(),
            "odd/imu: not joined: rates differ: 102.4 Hz and 100 Hz have no whole ratio");
  EXPECT_EQ(x.troubles(1).message(), "later/imu: not joined: it never ran at the same time as a");
  EXPECT_TRUE(got.arrays(0).has_report()) << "each device has its own, all the same";
}

TEST(CalibrationAcross, OneThatStoppedEarlyIsComparedWhileItRan) {
  Bench bench;
  bench.record({device("a", 16'384), device("brief", 2500)});
  const v1::Calibration got = bench.calibrated({"a/imu/gyro_x", "brief/imu/gyro_x"});
  ASSERT_EQ(got.arrays_size(), 1) << "of the channels that were named";
  const v1::ArrayCalibration& x = got.arrays(0);
  ASSERT_TRUE(x.has_report());
  EXPECT_TRUE(x.report().pairs(0).dependent());
  EXPECT_NEAR(x.join().seconds(), 75.0, 0.1);
  EXPECT_NEAR(x.join().streams(0).seconds(), 3 * 163.84, 0.1);
}

TEST(CalibrationAcross, ADamagedDeviceIsLeftOut) {
  Bench bench;
  bench.record({device("a", 2048), device("b", 2048), device("torn", 2048)});
  const auto chunk = bench.folder.path() / "replicate-2" / "torn" / "000001.h5";
  ASSERT_TRUE(recording::replace_file(bench.files, chunk, "no chunk"));
  const v1::Calibration got = bench.calibrated();
  const v1::ArrayCalibration& x = across(got, "gyro_x");
  EXPECT_EQ(x.channels_size(), 2);
  EXPECT_TRUE(x.has_report());
  ASSERT_EQ(x.troubles_size(), 1);
  EXPECT_NE(x.troubles(0).message().find("000001.h5"), std::string::npos);
}

TEST(CalibrationAcross, ADeviceAloneHasNoneAndNoneIsMadeUnasked) {
  Bench bench;
  bench.record({device("a", 2048), device("b", 2048)});
  CalibrateOptions options;
  options.models = {"WN"};
  options.diagnose = false;
  const auto unasked = calibrate(bench.files, bench.folder.path(), options);
  ASSERT_TRUE(unasked) << unasked.error().message;
  EXPECT_EQ(unasked->arrays_size(), 0);
  const v1::Calibration alone = bench.calibrated({"b/imu/gyro_x", "b/imu/gyro_y"});
  ASSERT_EQ(alone.arrays_size(), 1);
  EXPECT_EQ(alone.arrays(0).device(), "b");
  EXPECT_FALSE(alone.arrays(0).has_join());
}

}  // namespace
}  // namespace imunoise::study
