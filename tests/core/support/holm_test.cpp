#include "core/support/holm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace imunoise {
namespace {

// R: p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm") and ties at one.
TEST(Holm, GivesTheNumbersOfR) {
  EXPECT_TRUE(holm({}).empty());
  const auto four = holm(std::array{0.01, 0.04, 0.03, 0.005});
  const std::array expected = {0.03, 0.06, 0.06, 0.02};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(four[i], expected[i], 1e-15) << i;
  EXPECT_EQ(holm(std::array{0.6, 0.7, 0.6}), (std::vector<double>{1.0, 1.0, 1.0}));
}

// All hypotheses true, p-values independent: the chance of any rejection at 5 % is
// 1 - (1 - 0.05/4)^4 = 0.04907 for four. 20,000 draws: four standard
// errors are 0.0061, which chance exceeds once in 16,000.
TEST(Holm, RejectsTrueHypothesesAtItsLevel) {
  constexpr int kDraws = 20'000;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform;
  int rejected = 0;
  for (int i = 0; i < kDraws; ++i) {
    std::array<double, 4> p{};
    for (double& one : p) one = uniform(random);
    const auto adjusted = holm(p);
    rejected += *std::min_element(adjusted.begin(), adjusted.end()) < 0.05 ? 1 : 0;
  }
  EXPECT_NEAR(rejected / double{kDraws}, 0.04907, 0.0061) << "seed 7";
}

}  // namespace
}  // namespace imunoise
