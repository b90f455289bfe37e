// The test of a coefficient that is zero: as if samples were independent, and ours. Series share a
// slow process, and so do the regressors: what makes naive tests of slow effects so wrong.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "core/array/mixed_regression.h"
#include "core/array/simulate_array.h"
#include "study/figure/svg.h"
#include "study/report/figures/interval_figure.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kSeed = 20261122;
constexpr std::size_t kSets = 300;
constexpr std::size_t kSamples = 400;
constexpr Hertz kRate{1.0};

const ArrayLayout kLayout{4, {0, 0, 1, 1}};

ArrayModel model_of(const char* text) {
  return expand(parse_array_model(text, kRate).value(), kLayout);
}

// Which methods call the null coefficient significant at 5 %, and whose 95 % interval holds the one
// that is there.
struct Outcome {
  std::array<bool, 3> rejected{};  // naive, robust, GLS
  std::array<bool, 3> covered{};
};

Outcome outcome_of(std::size_t set) {
  const auto index = static_cast<std::uint32_t>(set);
  const ArrayModel noise =
      model_of("AR1(sigma2=0.1, phi=0.95)[all] + AR1(sigma2=0.1, phi=0.9)[group] + WN(sigma2=1)");
  const ArrayModel slow = model_of("AR1(sigma2=0.05, phi=0.97)[all]");
  constexpr double kEffect = 0.3;
  RegressionData data{
      simulate(noise, kSamples, kSeed, index),
      {simulate(slow, kSamples, kSeed + 1, index), simulate(slow, kSamples, kSeed + 2, index)},
      kRate};
  data.response += kEffect * data.regressors[1];
  RegressionOptions options;
  options.bootstraps = 99;
  options.seed = kSeed + set;
  const MixedRegression found = mixed_regression(
      parse_array_model("AR1[all] + AR1[group] + WN", kRate).value(), kLayout, data, options);
  Outcome out;
  const std::array methods = {&found.naive, &found.robust, &found.gls};
  for (std::size_t m = 0; m < methods.size(); ++m) {
    out.rejected[m] = (*methods[m])[0].p_value <= 0.05;
    const CoefficientEstimate& one = (*methods[m])[1];
    out.covered[m] = one.lower <= kEffect && kEffect <= one.upper;
  }
  return out;
}

TEST(MixedTrial, ANullCoefficientIsFoundAtTheLevelOnly) {
  std::array<double, 3> rejected{};
  std::array<double, 3> covered{};
  for (std::size_t set = 0; set < kSets; ++set) {  // each runs its bootstrap on all threads
    const Outcome one = outcome_of(set);
    for (std::size_t m = 0; m < 3; ++m) {
      rejected[m] += one.rejected[m] ? 1.0 / kSets : 0.0;
      covered[m] += one.covered[m] ? 1.0 / kSets : 0.0;
    }
  }
  std::printf("seed %llu, %zu sets of 4 series of %zu points, 99 bootstraps each\n",
              static_cast<unsigned long long>(kSeed), kSets, kSamples);
  constexpr std::array kNames = {"naive", "robust", "GLS"};
  constexpr std::array kTitles = {"as if samples were independent", "Huber's, by bootstrap",
                                  "GLS, by bootstrap"};
  for (std::size_t m = 0; m < 3; ++m) {
    std::printf(
        "%-6s: null coefficient rejected at 5 %%: %5.1f %%; 95 %% interval covers: %5.1f %%\n",
        kNames[m], 100.0 * rejected[m], 100.0 * covered[m]);
  }
  std::vector<report::IntervalRow> rows;
  for (std::size_t m = 0; m < 3; ++m) {
    const double reach = 1.96 * std::sqrt(rejected[m] * (1.0 - rejected[m]) / kSets);
    rows.push_back({kTitles[m], 100.0 * rejected[m], 100.0 * (rejected[m] - reach),
                    100.0 * (rejected[m] + reach), rejected[m] - reach > 0.05});
  }
  const char* const file = "mixed-null-coefficient.svg";
  auto drawn = report::interval_figure(
      "How often a coefficient that is zero is called an effect, at a level of 5 %",
      "rejected, % of the sets", "", rows, 5.0);
  drawn->subtitle =
      "Four series that share slow noise, regressed on slow series that have nothing to do with "
      "them";
  std::ofstream(file) << figure::svg(*drawn);
  std::printf("drawn in %s\n", file);
  const double allowance = 3.3 * std::sqrt(0.05 * 0.95 / kSets);
  EXPECT_GT(rejected[0], 0.3);
  for (const std::size_t m : {std::size_t{1}, std::size_t{2}}) {
    EXPECT_NEAR(rejected[m], 0.05, allowance) << kNames[m];
    EXPECT_NEAR(covered[m], 0.95, allowance) << kNames[m];
  }
}

}  // namespace
}  // namespace imunoise
