// The currency of the diagnosis: chances of a search.

#include "core/search/evidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/support/distributions.h"
#include "core/support/random.h"
#include "core/support/roots.h"

namespace imunoise {
namespace {

TEST(Evidence, WithoutASearchItIsTheTailOfTheRatio) {
  EXPECT_NEAR(log_p_value(2.0, 3.0, INFINITY, false), std::log(chi_square_tail(4.0, 3.0)), 1e-12);
  EXPECT_NEAR(log_p_value(2.0, 1.0, INFINITY, true), std::log(0.5 * chi_square_tail(4.0, 1.0)),
              1e-12);
  // Far out the expansion takes over without a step.
  EXPECT_NEAR(log_p_value(570.0, 4.0, INFINITY, false) - log_p_value(571.0, 4.0, INFINITY, false),
              1.0, 3e-3);
  EXPECT_NEAR(log_p_value(574.0, 4.0, INFINITY, false) - log_p_value(575.0, 4.0, INFINITY, false),
              1.0, 3e-3);
  EXPECT_EQ(log_p_value(0.0, 4.0, INFINITY, false), 0.0);
}

TEST(Evidence, AnUncertainLevelIsStudentsLaw) {
  // Regression on n = freedom + 1 numbers: Λ = n/2 log(1 + t²/freedom).
  const double freedom = 5.0;
  const double t = student_quantile(0.995, freedom);
  const double gain = 0.5 * (freedom + 1.0) * std::log1p(t * t / freedom);
  EXPECT_NEAR(std::exp(log_p_value(gain, 1.0, freedom, false)), 0.01, 1e-9);
}

// As many of 40 numbers as one likes: over all counts the chance is no larger than it says. 4,000
// sets, binomial bound of four standard deviations.
TEST(Evidence, HowManyIsPaidFor) {
  constexpr int kSets = 4000;
  constexpr int kNumbers = 40;
  RandomStream rng(43);
  int passed = 0;
  for (int set = 0; set < kSets; ++set) {
    std::vector<double> squares(kNumbers);
    for (double& one : squares) one = std::pow(rng.normal(), 2);
    std::sort(squares.rbegin(), squares.rend());
    double least = 0.0;
    double gain = 0.0;
    for (int count = 1; count <= kNumbers; ++count) {
      gain += 0.5 * squares[static_cast<std::size_t>(count) - 1];
      const Search search{.log_places = std::lgamma(kNumbers + 1.0) - std::lgamma(count + 1.0) -
                                        std::lgamma(kNumbers - count + 1.0) + log_number(count)};
      least = std::min(least, log_p_value(gain, count, INFINITY, false, search));
    }
    passed += least < std::log(0.05) ? 1 : 0;
  }
  EXPECT_LT(passed, kSets * 0.05 + 4.0 * std::sqrt(kSets * 0.05 * 0.95));
  double all = 0.0;
  for (int count = 1; count <= 100000; ++count) all += std::exp(-log_number(count));
  EXPECT_NEAR(all, 1.0, 1e-4);
}

// The best frequency of a wave in white noise: how often it passes what the path says it does once
// in twenty. 2,000 sets, binomial bounds of four standard deviations; the bound is an upper one
// that is close for rare crossings.
TEST(Evidence, ASearchIsAsLikelyToBeFooledAsItsPathSays) {
  constexpr int kSets = 2000;
  constexpr int kSamples = 64;
  constexpr int kGrid = 4 * kSamples;
  const Search search{0.5 * std::numbers::pi / std::sqrt(3.0) * kSamples, 0.0};
  const double high = root_between(
      [&](double nats) { return log_p_value(nats, 2.0, INFINITY, false, search) - std::log(0.05); },
      0.0, 50.0);
  RandomStream rng(42);
  int passed = 0;
  for (int set = 0; set < kSets; ++set) {
    std::vector<double> x(kSamples);
    for (double& one : x) one = rng.normal();
    double best = 0.0;
    for (int i = 2; i < kGrid - 2; ++i) {
      const double f = 0.5 * i / kGrid;
      std::complex<double> sum = 0.0;
      for (int t = 0; t < kSamples; ++t)
        sum += x[static_cast<std::size_t>(t)] * std::polar(1.0, -2.0 * std::numbers::pi * f * t);
      best = std::max(best, std::norm(sum) / kSamples);
    }
    passed += best > high ? 1 : 0;
  }
  const double share = static_cast<double>(passed) / kSets;
  std::printf("seed 42: %.4f of %d searches passed the 5 %% threshold\n", share, kSets);
  EXPECT_LT(share, 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / kSets));
  EXPECT_GT(share, 0.025);
}

// Without white noise a random walk that fits best has no power: the data are impossible.
TEST(Evidence, AnInfiniteGainLeavesNoChance) {
  for (const double noise_dof : {100.0, double{INFINITY}}) {
    EXPECT_EQ(log_p_value(INFINITY, 2.0, noise_dof, false), -INFINITY);
    EXPECT_EQ(log_p_value(INFINITY, 2.0, noise_dof, true, {.path = 3.0, .log_places = 2.0}),
              -INFINITY);
  }
}

TEST(Evidence, ThePathOfATurningVectorIsItsAngle) {
  Eigen::MatrixXd vectors(2, 91);
  for (Eigen::Index i = 0; i <= 90; ++i) {
    const double angle = std::numbers::pi * static_cast<double>(i) / 180.0;
    vectors(0, i) = 3.0 * std::cos(angle);
    vectors(1, i) = 3.0 * std::sin(angle);
  }
  EXPECT_NEAR(path_length(vectors), 0.5 * std::numbers::pi, 1e-9);
}

}  // namespace
}  // namespace imunoise
