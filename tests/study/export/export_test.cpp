#include "study/export/export.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/support/random.h"
#include "study/export/known_consumers.h"
#include "study/export/sha256.h"
#include "tests/study/export/example_imu.h"

namespace imunoise::testing {
namespace {

using study::AxisRule;
using study::consumer_called;
using study::export_noise;
using study::ExportOptions;

constexpr Hertz kAt{200.0};
const char* const kGyro = "WN(sigma2=8e-6) + RW(gamma2=8e-12)";

std::string written(const study::ImuNoise& imu, const char* to, const ExportOptions& options = {}) {
  const auto text = export_noise(imu, *consumer_called(to), {"imu.json", "abc"}, options);
  EXPECT_TRUE(text) << text.error().message;
  return text.value_or("");
}

ExportOptions by(AxisRule rule) {
  ExportOptions out;
  out.axes = rule;
  return out;
}

ExportOptions with_step(double seconds) {
  ExportOptions out;
  out.step = seconds;
  return out;
}

// Allan variance at the middle of each pair of grid points, and at them.
void expect_bound(const Model& model, const study::WhiteAndWalk& bound,
                  const study::Horizon& horizon) {
  const Model held{{Term(WhiteNoise{bound.n * bound.n * kAt.value}),
                    Term(RandomWalk{bound.k * bound.k / kAt.value})}};
  const auto first = static_cast<int>(horizon.begin * kAt.value);
  const auto last = static_cast<int>(horizon.end * kAt.value);
  const Eigen::ArrayXd m = Eigen::ArrayXd::LinSpaced(last - first + 1, first, last);
  const Eigen::ArrayXd ratio = variance(held, m) / variance(model, m);
  EXPECT_GT(ratio.minCoeff(), 1.0 - 1e-4);
  EXPECT_LT(ratio.minCoeff(), 1.0 + 1e-6) << "not the smallest";
  EXPECT_NEAR(std::sqrt(ratio.maxCoeff()), bound.most, 1e-3 * bound.most);
}

TEST(Conservative, OfWhiteNoiseAndRandomWalkIsThemselves) {
  const auto model = parse_model(kGyro, kAt).value();
  const auto bound = study::smallest_bound(model, kAt, {0.1, 10.0});
  EXPECT_NEAR(bound.n, std::sqrt(8e-6 / 200.0), 1e-6 * bound.n);
  EXPECT_NEAR(bound.k, std::sqrt(8e-12 * 200.0), 1e-4 * bound.k);
  EXPECT_NEAR(bound.most, 1.0, 1e-6);
}

TEST(Conservative, BoundsEveryAveragingTimeOfTheHorizon) {
  for (const char* const text :
       {"WN(sigma2=8e-6) + GM(sigma2=4e-8, tc=3) + RW(gamma2=1e-13)",
        "FN(b2=1e-8) + WN(sigma2=1e-6)", "QN(q2=1e-5) + WN(sigma2=1e-6) + GM(sigma2=1e-8, tc=300)",
        "WN(sigma2=1e-6)", "WN(sigma2=1e-6) + RES(sigma2=1e-12, r=0.99, omega=0.0628)"}) {
    SCOPED_TRACE(text);
    const auto model = parse_model(text, kAt);
    if (!model) FAIL() << model.error().message;
    for (const study::Horizon& horizon : {study::Horizon{0.1, 10.0}, study::Horizon{0.5, 60.0}})
      expect_bound(*model, study::smallest_bound(*model, kAt, horizon), horizon);
  }
}

// No other N and K that bound the model have a smaller mean ratio: scaled to bound, each is worse.
TEST(Conservative, NoOtherBoundIsSmaller) {
  const auto model = parse_model("WN(sigma2=8e-6) + GM(sigma2=4e-8, tc=3)", kAt).value();
  const Eigen::ArrayXd m = study::horizon_samples(kAt, {0.1, 10.0});
  const auto best = study::smallest_bound(model, kAt, {0.1, 10.0});
  const Eigen::ArrayXd allan = 2.0 * variance(model, m);
  for (const double tilt : {0.25, 0.5, 0.9, 1.1, 2.0, 4.0}) {
    const Model other{{Term(WhiteNoise{best.n * best.n * kAt.value}),
                       Term(RandomWalk{tilt * best.k * best.k / kAt.value})}};
    Eigen::ArrayXd ratio = 2.0 * variance(other, m) / allan;
    ratio /= ratio.minCoeff();
    EXPECT_GT(std::sqrt(ratio.mean()), best.usual * 0.999) << tilt;
  }
}

// Replicates are drawn from a log-normal distribution, the bound is made from their spread, and new
// draws stay below it as often as promised: 95 % of 2,000, ± 4.5 standard deviations (2.2 %).
TEST(Conservative, BoundsTheNextPowerOn) {
  const Model model = parse_model("WN(sigma2=1e-6)", kAt).value();
  v1::StationarityReport report;
  v1::ParameterSpread& spread = *report.add_spread();
  spread.set_term("WN");
  spread.set_parameter("sigma2");
  spread.set_replicates(400);
  spread.set_mean(1e-6);
  spread.set_relative(0.3);
  spread.set_moves(true);
  const auto draws = study::moving_parameters(model, report.spread());
  ASSERT_EQ(draws.size(), 1U);
  const Eigen::ArrayXd m = Eigen::ArrayXd::Constant(1, 50.0);
  const double bound = study::power_on_allan(model, draws, m, 0.95)(0);
  const double usual = 2.0 * variance(model, m)(0);
  RandomStream rng(99);
  int below = 0;
  for (int i = 0; i < 2000; ++i) below += usual * std::exp(0.3 * rng.normal()) < bound ? 1 : 0;
  EXPECT_NEAR(below / 2000.0, 0.95, 0.022);
  // Few replicates say less: the bound is wider.
  spread.set_replicates(4);
  EXPECT_GT(
      study::power_on_allan(model, study::moving_parameters(model, report.spread()), m, 0.95)(0),
      1.2 * bound);
  spread.set_moves(false);
  EXPECT_TRUE(study::moving_parameters(model, report.spread()).empty());
}

TEST(Export, ConservativeValuesGrowWithTheSpreadOfReplicates) {
  v1::FitReport fit;
  fit.set_channel("gyro_x");
  fit.set_unit("rad/s");
  fit.set_rate_hz(200.0);
  fit.set_fitted_model(kGyro);
  v1::FitReport moving = fit;
  v1::ParameterSpread& spread = *moving.add_spread();
  spread.set_term("RW");
  spread.set_parameter("gamma2");
  spread.set_replicates(6);
  spread.set_mean(8e-12);
  spread.set_relative(0.5);
  spread.set_moves(true);
  ExportOptions options;
  options.conservative = true;
  const auto walk = [&](const v1::FitReport& of) {
    const std::string file = written(study::imu_noise({{"", of}}).value(), "kalibr", options);
    EXPECT_EQ(file.find("95 % of power-ons") != std::string::npos, of.spread_size() > 0) << file;
    EXPECT_EQ(file.find("gamma2 of RW: typically 8e-12") != std::string::npos,
              of.spread_size() > 0);
    return numbers_of(file, "gyroscope_random_walk").front();
  };
  EXPECT_GT(walk(moving), 1.3 * walk(fit));
  // How they differ is told, too, where nothing bounds it.
  options.conservative = false;
  const std::string file = written(study::imu_noise({{"", moving}}).value(), "kalibr", options);
  EXPECT_NE(file.find("gamma2 of RW: typically 8e-12"), std::string::npos) << file;
  EXPECT_NE(file.find("--conservative bounds the next power-on"), std::string::npos) << file;
}

// Whether its estimate is zero or not, and whether the program would take zero.
TEST(Export, ARandomWalkThatTheDataDoNotShowIsItsUpperBound) {
  constexpr double kUpper = 3e-4;
  for (const double estimate : {0.0, 1e-4}) {
    auto imu = example_imu("WN(sigma2=8e-6)", "WN(sigma2=8e-6)", kAt);
    for (auto& axis : imu.gyro.axes) {
      axis.k = {estimate, 0.0, kUpper};
      axis.hidden_walk = true;
      axis.noise.terms.emplace_back(RandomWalk{estimate * estimate / axis.rate.value});
    }
    ExportOptions options;
    for (const auto& [to, key] :
         {std::pair("kalibr", "gyroscope_random_walk"), std::pair("orb-slam3", "IMU.GyroWalk")}) {
      const std::string file = written(imu, to, options);
      EXPECT_NEAR(numbers_of(file, key)[0], kUpper, 1e-6 * kUpper) << file;
      EXPECT_NE(file.find("the data show no random walk"), std::string::npos) << file;
    }
    options.conservative = true;
    const std::string safe = written(imu, "kalibr", options);
    EXPECT_GT(numbers_of(safe, "gyroscope_random_walk")[0], 0.999 * kUpper) << safe;
    EXPECT_NE(safe.find("the largest one that they allow"), std::string::npos) << safe;
  }
}

TEST(Export, NothingIsBoundWhereAProgramTakesNoWalk) {
  const auto imu = example_imu(kGyro, kGyro, kAt);
  const std::string plain = written(imu, "ros");
  EXPECT_EQ(plain.find("pass --conservative"), std::string::npos) << plain;
  ExportOptions options;
  options.conservative = true;
  const std::string safe = written(imu, "ros", options);
  EXPECT_NE(safe.find("N alone bounds nothing"), std::string::npos) << safe;
}

TEST(Export, KalibrNeverGetsZero) {
  const auto imu = example_imu("WN(sigma2=8e-6)", "WN(sigma2=1e-4) + GM(sigma2=1e-6, tc=100)", kAt);
  ExportOptions safe;
  safe.conservative = true;
  for (const ExportOptions& options : {ExportOptions{}, safe}) {
    const std::string file = written(imu, "kalibr", options);
    for (const char* const key : {"gyroscope_noise_density", "gyroscope_random_walk",
                                  "accelerometer_noise_density", "accelerometer_random_walk"}) {
      ASSERT_EQ(numbers_of(file, key).size(), 1U) << file;
      EXPECT_GT(numbers_of(file, key)[0], 0.0) << key << file;
    }
    EXPECT_NE(file.find("refuses 0"), std::string::npos) << file;
  }
  const std::string file = written(imu, "kalibr");
  EXPECT_NE(file.find("has no random walk; K bounds its error"), std::string::npos) << file;
  const std::string walk = written(example_imu("RW(gamma2=8e-12)", kGyro, kAt), "kalibr", safe);
  EXPECT_GT(numbers_of(walk, "gyroscope_noise_density")[0], 0.0) << walk;
}

// Smallest and largest ratio of the integrated error of white noise and a bias to a model's.
std::pair<double, double> ratio_to(const Model& model, double n, const Process& bias) {
  const Eigen::ArrayXd m = study::horizon_samples(kAt, {});
  const Model held{{Term(WhiteNoise{n * n * kAt.value}), Term(bias)}};
  const Eigen::ArrayXd ratio = (variance(held, m) / variance(model, m)).sqrt();
  return {ratio.minCoeff(), ratio.maxCoeff()};
}

// A Markov process of a second stands out of N at half a second, and out of N + K of a bound that
// has an N of its own.
TEST(Export, WhatIsSaidToBoundTheErrorDoes) {
  const char* const text = "WN(sigma2=8e-6) + GM(sigma2=4e-6, tc=1.07)";
  const std::string file = written(example_imu(text, kGyro, kAt), "kalibr");
  const double n = numbers_of(file, "gyroscope_noise_density")[0];
  const double k = numbers_of(file, "gyroscope_random_walk")[0];
  const auto [least, most] =
      ratio_to(parse_model(text, kAt).value(), n, RandomWalk{k * k / kAt.value});
  EXPECT_NEAR(least, 1.0, 1e-6) << file;
  EXPECT_EQ(file.find("times larger"), std::string::npos) << file;
  const std::string none = written(example_imu(text, kGyro, kAt), "ros");
  EXPECT_EQ(none.find("K bounds"), std::string::npos) << none;
}

// KF-GINS has one correlation time. σ·√(τ/T) made the error of the axis with T = 1 s eleven times
// too large over 30 s.
TEST(Export, OneCorrelationTimeForAllBoundsEachAxis) {
  auto imu = example_imu(kGyro, kGyro, kAt);
  const char* const models[] = {"WN(sigma2=8e-6) + GM(sigma2=2.7e-7, tc=1.07)",
                                "WN(sigma2=8e-6) + GM(sigma2=3.5e-7, tc=28)",
                                "WN(sigma2=8e-6) + RW(gamma2=8e-12)"};
  for (std::size_t i = 0; i < 3; ++i) {
    imu.gyro.axes[i] = study::axis_noise(imu.gyro.axes[i].channel, Quantity::kAngularRate, kAt,
                                         parse_model(models[i], kAt).value());
  }
  imu.accelerometer.axes.clear();
  const std::string file = written(imu, "kf-gins");
  const double tau = numbers_of(file, "corrtime").at(0) * 3600.0;
  const auto sigmas = numbers_of(file, "gbstd");
  ASSERT_EQ(sigmas.size(), 3U) << file;
  double worst = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double sigma = sigmas[i] / 3600.0 * std::numbers::pi / 180.0;
    const auto [least, most] =
        ratio_to(parse_model(models[i], kAt).value(), imu.gyro.axes[i].n.value,
                 GaussMarkov{sigma * sigma, tau, kAt});
    EXPECT_GT(least, 1.0 - 1e-5) << file;
    worst = std::max(worst, most);
  }
  EXPECT_LT(worst, 2.5) << file;
  EXPECT_NE(file.find("has one correlation time"), std::string::npos) << file;
}

TEST(Export, WhiteNoiseBehindAFilterIsWhiteToAConsumer) {
  const auto imu =
      example_imu("BUTTERWORTH(2, sigma2=8e-6, omega=1.2) + RW(gamma2=8e-12)", kGyro, kAt);
  const std::string file = written(imu, "kalibr");
  EXPECT_NEAR(numbers_of(file, "gyroscope_noise_density")[0], 2e-4, 1e-9) << file;
}

TEST(Export, AxesWorstMeanEach) {
  auto imu = example_imu(kGyro, kGyro, kAt);
  imu.gyro.axes[1].n.value *= 3.0;
  imu.gyro.axes[2].k.value *= 2.0;
  const double n = imu.gyro.axes[0].n.value;
  const double k = imu.gyro.axes[0].k.value;
  const auto near = [](const std::vector<double>& x, double value) {
    ASSERT_EQ(x.size(), 1U);
    EXPECT_NEAR(x[0], value, 1e-6 * value);
  };
  const std::string worst = written(imu, "kalibr");
  near(numbers_of(worst, "gyroscope_noise_density"), 3.0 * n);
  near(numbers_of(worst, "gyroscope_random_walk"), 2.0 * k);
  EXPECT_NE(worst.find("worst of gyro_x, gyro_y, gyro_z"), std::string::npos);
  const std::string mean = written(imu, "kalibr", by(AxisRule::kMean));
  near(numbers_of(mean, "gyroscope_noise_density"), n * std::sqrt(11.0 / 3.0));
  near(numbers_of(mean, "gyroscope_random_walk"), k * std::sqrt(2.0));
  EXPECT_NE(mean.find("root mean square of"), std::string::npos);
  EXPECT_NE(written(imu, "basalt").find("\"gyro_noise_std: rad/s/√Hz; N"), std::string::npos)
      << "JSON has no comments: units and formulas stand in an entry";
  const auto each = numbers_of(written(imu, "basalt"), "gyro_noise_std");
  ASSERT_EQ(each.size(), 3U);
  EXPECT_NEAR(each[1], 3.0 * each[0], 1e-6 * each[1]);
  const auto all = numbers_of(written(imu, "basalt", by(AxisRule::kWorst)), "gyro_noise_std");
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0], all[1]);
  const auto refused =
      export_noise(imu, *consumer_called("kalibr"), {"x", ""}, by(AxisRule::kEach));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("--axis worst or mean"), std::string::npos);
}

TEST(Export, StatesWhatAConsumerDoesNotTake) {
  const auto imu =
      example_imu("WN(sigma2=8e-6) + GM(sigma2=4e-6, tc=3) + RW(gamma2=8e-12)", kGyro, kAt);
  const std::string file = written(imu, "orb-slam3");
  EXPECT_NE(file.find("ORB-SLAM3 takes no Gauss-Markov noise"), std::string::npos) << file;
  EXPECT_NE(file.find("times larger"), std::string::npos) << file;
  EXPECT_NE(file.find("sha256 abc"), std::string::npos) << file;
  ExportOptions options;
  options.conservative = true;
  const std::string safe = written(imu, "orb-slam3", options);
  EXPECT_EQ(safe.find("times larger"), std::string::npos) << safe;
  EXPECT_NE(safe.find("overstate it by a factor of up to"), std::string::npos) << safe;
  EXPECT_GT(numbers_of(safe, "IMU.NoiseGyro")[0], numbers_of(file, "IMU.NoiseGyro")[0]);
}

// A random walk that hardly matters beside a Markov process, and the reverse.
TEST(Export, GazeboGetsTheBiasThatExplainsMore) {
  const auto imu = example_imu("WN(sigma2=8e-6) + GM(sigma2=4e-6, tc=3) + RW(gamma2=1e-15)",
                               "WN(sigma2=8e-6) + GM(sigma2=4e-10, tc=3) + RW(gamma2=1e-9)", kAt);
  const std::string file = written(imu, "gazebo");
  EXPECT_EQ(numbers_of(file, "<dynamic_bias_correlation_time").front(), 3.0) << file;
  EXPECT_NE(file.find("takes no random walk"), std::string::npos) << file;
  const std::string second = file.substr(file.find("<linear_acceleration>"));
  EXPECT_EQ(numbers_of(second, "<dynamic_bias_correlation_time").front(), study::kEndless);
  EXPECT_NE(file.find("takes no Gauss-Markov noise"), std::string::npos) << file;
}

TEST(Export, IsaacSimHasNoPlaceForNoise) {
  const auto refused =
      export_noise(example_imu(kGyro, kGyro, kAt), *consumer_called("isaac-sim"), {"x", ""}, {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("no noise fields"), std::string::npos);
}

TEST(Export, StepOfTheFilterChangesAutopilotsAlone) {
  const auto imu = example_imu(kGyro, kGyro, kAt);
  const double usual = numbers_of(written(imu, "px4"), "EKF2_GYR_NOISE")[0];
  const double slow = numbers_of(written(imu, "px4", with_step(0.04)), "EKF2_GYR_NOISE")[0];
  EXPECT_NEAR(slow, usual / 2.0, 1e-6 * usual);
  EXPECT_FALSE(export_noise(imu, *consumer_called("kalibr"), {"x", ""}, with_step(0.04)));
}

TEST(Export, IntervalsFollowTheFit) {
  v1::FitReport fit;
  fit.set_channel("gyro_x");
  fit.set_unit("rad/s");
  fit.set_rate_hz(200.0);
  fit.set_fitted_model(kGyro);
  fit.set_confidence(0.68);
  v1::Coefficient& n = *fit.add_terms()->add_coefficients();
  n.set_symbol("N");
  n.set_value(2e-4);
  n.set_lower(1.9e-4);
  n.set_upper(2.1e-4);
  const auto imu = study::imu_noise({{"", fit}});
  ASSERT_TRUE(imu) << imu.error().message;
  EXPECT_EQ(imu->gyro.axes[0].axis, 'x');
  const auto sheet = study::export_sheet(*imu, *consumer_called("gtsam"), {"x", ""}, {});
  ASSERT_TRUE(sheet);
  const auto& heading = sheet->heading;
  EXPECT_NE(std::find(heading.begin(), heading.end(), "  intervals: 68 % confidence"),
            heading.end());
  const study::Field& field = sheet->fields.front();
  EXPECT_EQ(field.key, "gyroscopeCovariance");
  ASSERT_EQ(field.values.size(), 3U);
  EXPECT_DOUBLE_EQ(field.values[0].lower, 1.9e-4 * 1.9e-4);
  EXPECT_DOUBLE_EQ(field.values[0].upper, 2.1e-4 * 2.1e-4);
  const auto twice = study::imu_noise({{"", fit}, {"", fit}});
  ASSERT_FALSE(twice);
  EXPECT_NE(twice.error().message.find("is there twice"), std::string::npos);
}

// FIPS 180-4 examples, and lengths around the block of 64 bytes (from sha256sum).
TEST(Sha256, KnownDigests) {
  EXPECT_EQ(study::sha256("abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(study::sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(study::sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(study::sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  // In pieces of any length, with and without the processor's own instructions.
  const std::string text(100'000, 'b');
  for (const bool portable : {false, true}) {
    study::Sha256 hash(portable);
    std::size_t length = 1;
    for (std::size_t at = 0; at < text.size();) {
      hash.add(std::string_view(text).substr(at, length));
      at += length;
      length = length * 7 % 1009;
    }
    EXPECT_EQ(hash.hex(), study::sha256(text)) << portable;
    study::Sha256 first(portable);
    first.add("abc");
    EXPECT_EQ(first.hex(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  }
}

}  // namespace
}  // namespace imunoise::testing
