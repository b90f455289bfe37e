#include "core/effects/distributions/wandering_power.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/diagnosis/candidates.h"
#include "core/search/search_view.h"
#include "tests/core/diagnosis/subject_of.h"
#include "tests/core/effect/wandering_noise.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

constexpr Hertz kWanderRate{50.0};

// Correlation time in s.
Innovations wandering(double tau, double deviation, std::uint64_t seed) {
  return wandering_noise(tau * kWanderRate.value, deviation, seed, 16'384);
}

// Of three samples to seven seconds. Of 10 intervals of 95 % at each, 7 hold the truth but for one
// set of tests in 1,000; the time within a factor of 1.3, as only some 45 of the longest fit in.
TEST(WanderingPower, FindsItsTimeAndSize) {
  FIGURES_ALONE();
  constexpr double kDeviation = 0.7;
  for (const double tau : {0.06, 0.3, 7.0}) {
    int held = 0;
    double log_tau = 0.0;
    for (std::uint64_t seed = 9300; seed < 9310; ++seed) {
      const auto found =
          WanderingPower::from(wandering(tau, kDeviation, seed), kWanderRate, 2.0 * tau);
      const double off = std::abs(std::log(found.deviation() / kDeviation));
      held += off < 1.96 * found.deviation_error() ? 1 : 0;
      log_tau += std::log(found.tau_s() / tau) / 10.0;
      EXPECT_GT(found.gain(), 100.0);
    }
    EXPECT_GE(held, 7) << tau;
    EXPECT_NEAR(log_tau, 0.0, std::log(1.3)) << tau;
  }
}

// Each number is that of the same tail probability, given those before it. Bounds: four standard
// errors of the kurtosis, and of the correlation of neighbouring squares.
TEST(WanderingPower, LeavesNormalNumbersOfOnePower) {
  for (const double tau : {0.06, 0.3, 7.0}) {
    const Innovations noise = wandering(tau, 1.0, 9320);
    const auto found = WanderingPower::of(noise, kWanderRate, tau);
    double fourth = 0.0;
    double product = 0.0;
    double samples = 0.0;
    for (std::size_t k = 0; k < noise.white.size(); ++k) {
      Eigen::ArrayXd even = noise.white[k].array() * found.evened(noise.white[k]).factor;
      even /= std::sqrt(even.square().mean());
      const Eigen::Index n = even.size();
      fourth += even.square().square().sum();
      product +=
          ((even.head(n - 1).square() - 1.0) * (even.tail(n - 1).square() - 1.0)).sum() / 2.0;
      samples += static_cast<double>(n);
    }
    EXPECT_NEAR(fourth / samples, 3.0, 4.0 * std::sqrt(24.0 / samples)) << tau;
    EXPECT_NEAR(product / samples, 0.0, 4.0 / std::sqrt(samples)) << tau;
  }
}

TEST(WanderingPower, OfASilentReplicateIsNothing) {
  Innovations noise = wandering(0.3, 1.0, 9330);
  noise.white[1].setZero();
  const auto found = WanderingPower::of(noise, kWanderRate, 0.3);
  EXPECT_EQ(found.gain(), 0.0);
  EXPECT_EQ(found.evened(noise.white[1]).factor.minCoeff(), 1.0);
}

// Power that wanders within a few samples has tails, and looks like many short bursts.
TEST(WanderingPower, FastIsNeitherTailsNorBursts) {
  const Innovations noise = wandering(0.1, 1.0, 9340);
  const auto subject = subject_of({.model = "WN(sigma2=1e-12)",
                                   .samples = 16'384,
                                   .replicates = 2,
                                   .added = [&](std::size_t k, double s) {
                                     return noise.white[k](std::lround(s * kWanderRate.value));
                                   }});
  const Diagnosis diagnosis = diagnose(fitted(subject, "WN"));
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].tried.cause, "variance_wander");
  EXPECT_NEAR((*diagnosis.effects[0].tried.term())["tau"], 0.1, 0.03);
}

// By chance above 5 % once in twenty, so that of 40 sets 7 or more are 1 in 300.
TEST(WanderingPower, ChanceIsWhatTheSearchSays) {
  int beyond = 0;
  for (std::uint64_t seed = 9350; seed < 9390; ++seed) {
    const FittedModel plain = fitted(subject_of({.model = "WN(sigma2=1)", .seed = seed}), "WN");
    const Current current = current_of(plain.regression, plain.fit);
    for (const TriedTerm& one :
         try_all(current, effect_named("variance_wander").search(SearchView(current))))
      beyond += one.log_p < std::log(0.05) ? 1 : 0;
  }
  EXPECT_LT(beyond, 7);
}

}  // namespace
}  // namespace imunoise
