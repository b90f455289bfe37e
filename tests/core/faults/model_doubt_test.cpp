// What a detector makes of a model that was fitted to few readings.

#include "core/faults/model_doubt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/array/array_inference.h"
#include "tests/core/faults/faulty_array.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kDoubtSeed = 20261129;

// White noise of each sensor, fitted to `readings` readings.
ArrayFit white_fit(const std::vector<double>& variances, double readings) {
  ArrayFit out;
  const auto sensors = static_cast<Eigen::Index>(variances.size());
  out.model = testing::array_model("WN", sensors, {1.0});
  out.parameters = parameters_of(out.model);
  out.covariance = Eigen::MatrixXd::Zero(sensors, sensors);
  for (Eigen::Index i = 0; i < sensors; ++i) {
    const double variance = variances[static_cast<std::size_t>(i)];
    set_value(out.model, out.parameters[static_cast<std::size_t>(i)], variance);
    out.covariance(i, i) = 2.0 * variance * variance / readings;
  }
  return out;
}

TEST(ModelDoubt, TheDifferenceOfTwoSensorsIsKnownTwiceAsWell) {
  const ArrayFit fit = white_fit({1.0, 1.0}, 50.0);
  const InnovationFilter filter(fit.model, parity_rows(2, {0, 1}), 1);
  const Eigen::MatrixXd alone = Eigen::MatrixXd::Ones(1, 1);
  EXPECT_NEAR(ModelDoubt(fit, 50.0).degrees(filter, alone), 100.0, 0.1);
  EXPECT_EQ(ModelDoubt().degrees(filter, alone), ModelDoubt::kNone);
}

TEST(ModelDoubt, AUnitOfPowerChangesNothing) {
  const ArrayFit small = white_fit({1e-12, 1e-10}, 50.0);
  const ArrayFit large = white_fit({1e2, 1e4}, 50.0);
  const auto degrees = [](const ArrayFit& fit) {
    const InnovationFilter filter(fit.model, parity_rows(2, {0, 1}), 4);
    return ModelDoubt(fit, 50.0).degrees(filter, Eigen::MatrixXd::Ones(1, 1));
  };
  EXPECT_NEAR(degrees(small), degrees(large), 1e-3 * degrees(large));
}

// The fit knows nothing about its Markov process and its ramp. It still knows the noise of single
// readings.
TEST(ModelDoubt, WhatTheFitCannotTellApartDoesNotBlindIt) {
  ArrayFit fit;
  fit.model = testing::array_model("AR1(phi=-0.995) + WN + DR", 2, {1e-9, 1.0, 1e-12});
  fit.parameters = parameters_of(fit.model);
  const auto count = static_cast<Eigen::Index>(fit.parameters.size());
  fit.covariance = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    fit.covariance(i, i) = fit.parameters[static_cast<std::size_t>(i)].parameter > 0 ? 5e3 : 1e-3;
  for (const std::int64_t block : {1, 64}) {
    const InnovationFilter filter(fit.model, parity_rows(2, {0, 1}), block);
    const double degrees =
        ModelDoubt(fit, 2000.0).degrees(filter, Eigen::MatrixXd::Ones(1, filter.outputs()));
    EXPECT_GE(degrees, 500.0 / static_cast<double>(block));
    EXPECT_TRUE(std::isfinite(degrees));
  }
  FaultOptions options;
  options.longest = 2000;
  options.doubt = ModelDoubt(fit, 2000.0);
  FaultDetector detector(fit.model, Hertz{1.0}, options);
  auto data = testing::simulated_array(testing::array_model("WN", 2, {1.0}), 2000, kDoubtSeed, 1);
  for (std::size_t t = 1000; t < 2000; ++t) data[0][t] += 10.0;
  EXPECT_FALSE(testing::faults_in(detector, data).empty());
}

// A variance that is known to 18 % only, compared with those of thousands of readings: taken for
// the truth, it makes most recordings noisy. One alarm a recording counts.
TEST(ModelDoubt, FewReadingsRaiseNoMoreFalseAlarmsThanAllowed) {
  FIGURES_ALONE();
  constexpr std::size_t kRuns = 120;
  constexpr std::size_t kSamples = 4096;
  constexpr int kTrained = 64;
  const double allowed = 24.0 / kRuns;  // alarms a recording; a third of them is for sticking
  const ArrayModel truth = testing::array_model("WN", 2, {1.0});
  RandomStream random(kDoubtSeed);
  int alarmed = 0;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    std::vector<double> variances(2, 0.0);
    for (double& one : variances) {
      for (int t = 0; t < kTrained; ++t) one += std::pow(random.normal(), 2) / kTrained;
    }
    const ArrayFit fit = white_fit(variances, kTrained);
    FaultOptions options;
    options.false_alarms_per_hour = 1.5 * allowed * 3600.0 / kSamples;
    options.longest = 64;
    options.doubt = ModelDoubt(fit, kTrained);
    FaultDetector detector(fit.model, Hertz{1.0}, options);
    const auto data = testing::simulated_array(truth, kSamples, kDoubtSeed, run);
    alarmed += testing::faults_in(detector, data).empty() ? 0 : 1;
  }
  const double expected = allowed * kRuns;
  std::printf("seed %llu: %d of %zu recordings alarm, %.0f allowed\n",
              static_cast<unsigned long long>(kDoubtSeed), alarmed, kRuns, expected);
  EXPECT_LT(alarmed, expected + 3.0 * std::sqrt(expected * (1.0 - allowed)));
}

}  // namespace
}  // namespace imunoise
