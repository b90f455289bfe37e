// Residuals of a model that was fitted to more than they show.

#include "core/diagnosis/views/efficient_residuals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/diagnosis/views/misfit.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

constexpr Eigen::Index kShown = 8;  // of 32 numbers about a mean, which is fitted to all of them

TEST(EfficientResiduals, AreStandardNormalUnderTheModel) {
  constexpr int kTrials = 2000;
  std::mt19937_64 random(8301);
  std::normal_distribution<double> normal;
  double sum = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Eigen::VectorXd all(4 * kShown);
    for (double& one : all) one = normal(random);
    all.array() -= all.mean();
    const TestOutcome test =
        test_after_fit(all.head(kShown), Eigen::MatrixXd::Ones(kShown, 1),
                       Eigen::MatrixXd::Constant(1, 1, 4.0 * static_cast<double>(kShown)));
    ASSERT_EQ(test.degrees_of_freedom, kShown);
    sum += test.statistic;
  }
  // A mean of χ²_8: standard error √(16/2000) = 0.089.
  EXPECT_NEAR(sum / kTrials, static_cast<double>(kShown), 4.0 * 0.089);
}

// The same deviation of all numbers: another mean explains it, but that is not what was fitted.
TEST(EfficientResiduals, WhatOtherParametersWouldExplainCountsWhereTheFitDidNotTakeIt) {
  const Eigen::VectorXd off = Eigen::VectorXd::Constant(kShown, 3.0);
  const Eigen::MatrixXd a = Eigen::MatrixXd::Ones(kShown, 1);
  EXPECT_LT(test_after_fit(off, a, 4.0 * a.transpose() * a).p_value, 1e-10);
  const TestOutcome own = test_after_fit(off, a, a.transpose() * a);
  EXPECT_EQ(own.degrees_of_freedom, kShown - 1);
  EXPECT_NEAR(own.statistic, 0.0, 1e-9);
}

// A Butterworth filter of second order at half the band, and a little rounding, taken for a
// triangular filter with two peaks: their parameters could explain what half octaves show, and the
// values that were fitted do not.
TEST(EfficientResiduals, AFilterIsNotExplainedByPeaks) {
  constexpr std::size_t kSamples = 65536;
  const Model white{{Term(Process(WhiteNoise{1.0}))}};
  std::vector<std::vector<double>> filtered;
  for (std::uint32_t k = 0; k < 2; ++k) {
    const std::vector<double> x = simulate(white, kSamples, 8303, k);
    std::vector<double>& y = filtered.emplace_back(kSamples, 0.0);
    for (std::size_t t = 2; t < kSamples; ++t)
      y[t] = 0.2929 * (x[t] + 2.0 * x[t - 1] + x[t - 2]) - 0.1716 * y[t - 2];
  }
  const auto subject =
      subject_of({.model = "WN(sigma2=1e-4)",
                  .samples = kSamples,
                  .replicates = 2,
                  .seed = 8304,
                  .added = [&](std::size_t k, double s) {
                    return filtered[k][static_cast<std::size_t>(std::lround(50.0 * s))];
                  }});
  const MisfitReport misfit = misfit_of(fitted(subject, "BARTLETT(2) + RW + 2*VOIGT"));
  double worst = 0.0;
  for (const BandMisfit& one : misfit.bands) worst = std::max(worst, std::abs(one.sigma));
  EXPECT_GT(worst, 8.0);
  EXPECT_LT(misfit.spectrum.p_value, 1e-12);
}

}  // namespace
}  // namespace imunoise
