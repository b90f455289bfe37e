// Tables of deviations: how far their intervals can be trusted.

#include "study/deviation/deviations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "core/model/model.h"
#include "core/support/distributions.h"

namespace imunoise::study {
namespace {

// At the longest averaging times a slope is known badly: white noise is not to be taken for
// rounding, which has ten thousand times as many degrees of freedom.
TEST(Deviations, IntervalsOfTheLongestTimesCoverWhiteNoise) {
  constexpr Hertz kRate{200.0};
  constexpr std::uint64_t kSeeds = 60;
  const Model truth = *parse_model("WN(sigma2=1)", kRate);
  int covered = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const std::vector<double> x = simulate(truth, 60'000, seed, 0);
    const Series series{"x", {"one"}, {Signal(std::span<const double>(x), kRate)}, {}};
    const auto report = deviations(series, DeviationKind::kAllan, 0.95);
    ASSERT_TRUE(report) << report.error().message;
    const v1::DeviationPoint& last = *report->points().rbegin();
    EXPECT_NE(last.noise(), "QN") << "seed " << seed;
    EXPECT_LT(last.degrees_of_freedom(), 10.0) << "seed " << seed;
    const double truth_there = 1.0 / std::sqrt(static_cast<double>(last.samples()));
    covered += last.lower() <= truth_there && truth_there <= last.upper() ? 1 : 0;
  }
  std::cout << "seeds 1 to " << kSeeds << ": " << covered << " cover\n";
  // 95 % of 60 with a chance of 1e-3 of fewer: 57 - 3.1 · 1.7.
  EXPECT_GE(covered, 51);
}

// Rounding is found where it is beyond chance.
TEST(Deviations, RoundingHasItsOwnDegreesOfFreedom) {
  constexpr Hertz kRate{200.0};
  const std::vector<double> x = simulate(*parse_model("QN(q2=1)", kRate), 60'000, 1, 0);
  const Series series{"x", {"one"}, {Signal(std::span<const double>(x), kRate)}, {}};
  const auto report = deviations(series, DeviationKind::kAllan, 0.95);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->points(1).noise(), "QN");
  EXPECT_EQ(report->points(3).noise(), "QN");
}

}  // namespace
}  // namespace imunoise::study
