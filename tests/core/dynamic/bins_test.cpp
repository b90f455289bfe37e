// Which samples belong to which covariate.

#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamic/covariate_bins.h"
#include "core/support/random.h"

namespace imunoise {
namespace {

using Recording = std::vector<double>;

// Dwells of 1,000 samples with ramps of 20 between them, and noise on the covariate.
Recording staircase(const std::vector<double>& levels, double noise) {
  RandomStream random(11);
  Recording out;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    for (int k = 0; k < 20 && i > 0; ++k) {
      out.push_back(levels[i - 1] + (levels[i] - levels[i - 1]) * (k + 0.5) / 20.0);
    }
    for (int k = 0; k < 1000; ++k) out.push_back(levels[i] + noise * random.normal());
  }
  return out;
}

TEST(Bins, FindPlateausAndLeaveOutTheWayBetweenThem) {
  for (const double noise : {0.0, 0.3}) {
    const std::vector<Recording> one = {staircase({30, 90, 150, 210}, noise)};
    const Bins found = bin_by_covariate(one, {});
    ASSERT_EQ(found.bins.size(), 4U) << noise;
    EXPECT_TRUE(found.plateaus);
    for (std::size_t b = 0; b < 4; ++b) {
      const Bin& bin = found.bins[b];
      EXPECT_NEAR(bin.mean, 30.0 + 60.0 * static_cast<double>(b), 0.05);
      ASSERT_EQ(bin.runs.size(), 1U) << noise;  // its noise does not cut it
      EXPECT_NEAR(static_cast<double>(bin.runs[0].begin), 1020.0 * static_cast<double>(b), 1.0);
      EXPECT_NEAR(static_cast<double>(bin.samples), 1000.0, 2.0);
    }
    // The ends of a ramp lie within the scatter.
    EXPECT_NEAR(static_cast<double>(found.left_out), 60.0, noise > 0.0 ? 10.0 : 0.0);
  }
}

TEST(Bins, TakeUpAPlateauAgainAsAnotherRun) {
  const std::vector<Recording> two = {staircase({30, 90, 30}, 0.0), staircase({90, 30}, 0.0)};
  BinOptions options;
  options.settle = 100;
  const Bins found = bin_by_covariate(two, options);
  ASSERT_EQ(found.bins.size(), 2U);
  ASSERT_EQ(found.bins[0].runs.size(), 3U);
  EXPECT_EQ(found.bins[0].runs[1].begin, 2140U);
  EXPECT_EQ(found.bins[0].runs[1].count, 900U);
  EXPECT_EQ(found.bins[0].runs[2].recording, 1U);
  EXPECT_EQ(found.left_out, 3U * 20U + 5U * 100U);
}

TEST(Bins, AreQuantilesWhereTheCovariateOnlyPasses) {
  Recording ramp(8000);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<double>(i);
  const Bins found = bin_by_covariate(std::vector<Recording>{ramp}, {});
  EXPECT_FALSE(found.plateaus);
  ASSERT_EQ(found.bins.size(), kCustomaryBins);
  for (const Bin& bin : found.bins) EXPECT_EQ(bin.samples, 1000U);
  EXPECT_EQ(found.left_out, 0U);
  BinOptions five;
  five.count = 5;
  EXPECT_EQ(bin_by_covariate(std::vector<Recording>{ramp}, five).bins.size(), 5U);
  // Few distinct values make fewer bins, none of them empty.
  const Recording two_values = staircase({1, 2}, 0.0);
  EXPECT_LE(bin_by_covariate(std::vector<Recording>{two_values}, five).bins.size(), 5U);
}

TEST(Bins, AreNotCutByTheNoiseOfAPassingCovariate) {
  RandomStream random(12);
  Recording ramp(8000);
  for (std::size_t i = 0; i < ramp.size(); ++i) {
    ramp[i] = static_cast<double>(i) + 200.0 * random.normal();
  }
  const Bins found = bin_by_covariate(std::vector<Recording>{ramp}, {});
  EXPECT_LT(found.left_out, 400U);
  for (std::size_t b = 0; b < found.bins.size(); ++b) {
    EXPECT_NEAR(found.bins[b].mean, 500.0 + 1000.0 * static_cast<double>(b), 500.0);
    EXPECT_LT(found.bins[b].runs.size(), 20U);
  }
}

TEST(Bins, LieWhereTheUserSays) {
  const std::vector<Recording> one = {staircase({30, 90, 150, 210}, 0.3)};
  BinOptions options;
  options.values = {150, 30, 1000};
  const Bins found = bin_by_covariate(one, options);
  ASSERT_EQ(found.bins.size(), 2U);  // nothing was recorded near 1000
  EXPECT_NEAR(found.bins[0].mean, 30.0, 0.05);
  EXPECT_NEAR(found.bins[1].mean, 150.0, 0.05);
}

TEST(Bins, WithoutMovementAreOne) {
  const Bins found = bin_by_covariate(std::vector<Recording>{Recording(500, 3.5)}, {});
  ASSERT_EQ(found.bins.size(), 1U);
  EXPECT_EQ(found.bins[0].samples, 500U);
  EXPECT_EQ(found.bins[0].mean, 3.5);
  EXPECT_TRUE(bin_by_covariate(std::vector<Recording>{Recording(10, 3.5)}, {}).bins.empty());
  EXPECT_TRUE(bin_by_covariate(std::vector<Recording>{}, {}).bins.empty());
}

}  // namespace
}  // namespace imunoise
