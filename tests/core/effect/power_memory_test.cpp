#include "core/effects/distributions/power_memory.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/effects/distributions/wandering_power.h"
#include "core/effects/reshaped_noise.h"
#include "tests/core/effect/wandering_noise.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

Innovations remembering(double tau, double deviation, std::uint64_t seed) {
  return wandering_noise(tau, deviation, seed, 65'536);
}

PowerMemory most_shown(const Innovations& noise) {
  PowerMemory out;
  for (const PowerMemory& one : power_memory(noise)) {
    if (one.nats > out.nats) out = one;
  }
  return out;
}

// Of power that moves by a fifth over some samples, the exact likelihood gains what the score test
// promises, within a third and twice what chance adds to either (a standard deviation of the root
// of twice the nats). Where a course is long enough to be seen, it gains less.
TEST(PowerMemory, SaysWhatFollowingThePowerGains) {
  FIGURES_ALONE();
  for (const double tau : {4.0, 8.0, 100.0, 1000.0}) {
    for (const std::uint64_t seed : {9400U, 9401U}) {
      SCOPED_TRACE(testing::Message() << "tau " << tau << ", seed " << seed);
      const Innovations noise = remembering(tau, 0.2, seed);
      const PowerMemory memory = most_shown(noise);
      const double exact = WanderingPower::of(noise, Hertz{1.0}, tau).gain();
      const double chance = exact / 3.0 + 2.0 * std::sqrt(2.0 * exact);
      EXPECT_GT(memory.nats, exact - chance);
      if (tau < 10.0) {
        EXPECT_LT(memory.nats, exact + chance);
      }
      EXPECT_NEAR(std::log(memory.tau / tau), 0.0, std::log(4.0));
    }
  }
}

// At each of 16 correlation times a standard normal number, which is beyond 2.45 once in 140: of 40
// sets, 4.6 at most remember so much. More than 13 do once in 10,000 such tests.
TEST(PowerMemory, OfConstantPowerIsNone) {
  int seen = 0;
  for (std::uint64_t seed = 9410; seed < 9450; ++seed)
    seen += most_shown(remembering(10.0, 0.0, seed)).nats > 3.0 ? 1 : 0;
  EXPECT_LE(seen, 13);
}

// A few outliers make no memory: two in each of two replicates, of 30 standard deviations.
TEST(PowerMemory, OutliersRememberNothing) {
  Innovations noise = remembering(10.0, 0.0, 9460);
  for (Eigen::VectorXd& white : noise.white) {
    white(1000) = 30.0;
    white(1003) = -30.0;
  }
  EXPECT_LT(most_shown(noise).nats, 3.0);
}

// Neighbours that resemble each other, because a spectrum is wrong, have squares that do, but no
// tails. They do not hide that the power wanders.
TEST(PowerMemory, OfAWrongSpectrumDoesNotCount) {
  Innovations noise = remembering(200.0, 0.1, 9480);
  for (Eigen::VectorXd& white : noise.white) {
    for (Eigen::Index t = 1; t < white.size(); ++t) white(t) += 0.3 * white(t - 1);
  }
  EXPECT_LT(most_shown(noise).tau, 10.0);
  const auto found = memory_of_power(noise);
  ASSERT_TRUE(found);
  EXPECT_NEAR(std::log(found->tau / 200.0), 0.0, std::log(4.0));
}

TEST(PowerMemory, OfSilenceIsNone) {
  Innovations noise = remembering(10.0, 0.0, 9470);
  for (Eigen::VectorXd& white : noise.white) white.setZero();
  EXPECT_TRUE(power_memory(noise).empty());
  EXPECT_TRUE(power_memory({}).empty());
}

}  // namespace
}  // namespace imunoise
