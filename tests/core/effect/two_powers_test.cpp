#include "core/effects/distributions/two_powers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace imunoise {
namespace {

constexpr Eigen::Index kBurstingSamples = 1 << 18;

// Noise whose power is `ratio` times as large in bursts of so many samples, one in four of the
// time. They begin and end at multiples of `grid` samples.
Innovations bursting(double ratio, unsigned seed, double length = 64.0, Eigen::Index grid = 16) {
  Innovations out;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  for (std::size_t k = 0; k < 4; ++k) {
    Eigen::VectorXd& white = out.white.emplace_back(kBurstingSamples);
    bool loud = false;
    for (Eigen::Index t = 0; t < kBurstingSamples; ++t) {
      const double chance = static_cast<double>(grid) / (loud ? length : 3.0 * length);
      if (t % grid == 0 && uniform(random) < chance) loud = !loud;
      white(t) = normal(random) * (loud ? std::sqrt(ratio) : 1.0);
    }
    out.replicates.push_back(k);
  }
  return out;
}

// Bursts too weak to be told one by one: what is left has normal tails and even power. Divided by
// the course that explains it best, its tails would be lighter than normal ones.
TEST(TwoPowers, LeaveNormalNumbersOfBurstsThatAreUncertain) {
  for (const double ratio : {1.5, 6.0}) {
    for (const unsigned seed : {20261125U, 20261126U}) {
      SCOPED_TRACE(testing::Message() << "ratio " << ratio << ", seed " << seed);
      const Innovations noise = bursting(ratio, seed);
      const TwoPowers powers = TwoPowers::of(noise, Hertz{100.0});
      EXPECT_NEAR(powers.ratio(), ratio, 0.1 * ratio);
      double squares = 0.0;
      double fourth = 0.0;
      double beside = 0.0;  // products of neighbouring powers
      for (std::size_t k = 0; k < noise.white.size(); ++k) {
        const Eigen::ArrayXd even = noise.white[k].array() * powers.factor(k, noise.white[k]);
        squares += even.square().sum();
        fourth += even.square().square().sum();
        beside +=
            (even.head(kBurstingSamples - 1) * even.tail(kBurstingSamples - 1)).square().sum();
      }
      const auto n = static_cast<double>(4 * kBurstingSamples);
      const double variance = squares / n;
      constexpr double kMany = 4.0;  // standard deviations
      EXPECT_NEAR(fourth / n / (variance * variance), 3.0, kMany * std::sqrt(24.0 / n));
      EXPECT_NEAR(beside / n / (variance * variance), 1.0, kMany * std::sqrt(12.0 / n));
      EXPECT_NEAR(variance, 1.0, 0.05) << "the smaller power";
    }
  }
}

// Bursts that begin and end anywhere. Half a million loud samples tell the ratio to 0.3 %; edges
// that are known to two samples or so move it by 2 %.
TEST(TwoPowers, HaveTheirRatioWhereverTheyBegin) {
  for (const double length : {100.0, 200.0, 2000.0}) {
    const TwoPowers powers = TwoPowers::of(bursting(9.0, 20261128U, length, 1), Hertz{100.0});
    EXPECT_NEAR(powers.ratio(), 9.0, 0.03 * 9.0) << length;
    // The standard error of a mean of so many exponential times, four times.
    const double reach = 4.0 * std::sqrt(4.0 * length / (4.0 * kBurstingSamples));
    EXPECT_NEAR(powers.times().length_s, length / 100.0, reach * length / 100.0) << length;
    EXPECT_NEAR(powers.times().every_s, 4.0 * length / 100.0, reach * 4.0 * length / 100.0)
        << length;
  }
}

}  // namespace
}  // namespace imunoise
