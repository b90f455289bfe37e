// Size and power of the tests for drift: on normal estimates, and on coefficients of fits to
// simulated recordings. A size may lie below its nominal value, and above it only by chance: 3.3
// binomial standard errors, 1 false alarm in 1,000.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "core/inference/parameter_history.h"
#include "core/support/distributions.h"
#include "core/support/parallel.h"
#include "tests/core/inference/simulated_sets.h"

namespace imunoise {
namespace {

using Estimates = std::vector<DatedEstimate>;

constexpr std::uint64_t kSeed = 20'261'122;
constexpr std::size_t kSets = 4'000;

struct Scatter {
  const char* words;
  double tau;     // between recordings, where the intervals' standard error is 1
  double uneven;  // standard errors from 1 to this
};

// `jump` moves the last estimate, `slope` the last from the first, in standard deviations of one.
Estimates drawn(const Scatter& scatter, std::size_t count, double jump, double slope,
                std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Estimates out;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    const double error = 1.0 + (scatter.uneven - 1.0) * static_cast<double>(i % 3) / 2.0;
    const double spread = std::hypot(error, scatter.tau);
    double value = spread * normal(random) + slope * std::hypot(1.0, scatter.tau) * share;
    if (i + 1 == count) value += jump * spread;
    out.push_back({static_cast<double>(i), value, error * error});
  }
  return out;
}

template <class Test>
double share_below(double level, const Scatter& scatter, std::size_t count, double jump,
                   double slope, const Test& test) {
  std::vector<char> found(kSets);
  for_each_index(kSets, [&](std::size_t i) {
    found[i] = test(drawn(scatter, count, jump, slope, kSeed + i))->p_value < level ? 1 : 0;
  });
  double sum = 0.0;
  for (const char one : found) sum += one;
  return sum / static_cast<double>(kSets);
}

const auto kNewest = [](const Estimates& all) { return test_newest(all); };
const auto kTrend = [](const Estimates& all) { return test_trend(all); };

TEST(ParameterHistoryTrial, SizeAndPowerOnNormalEstimates) {
  for (const Scatter scatter :
       {Scatter{"intervals say all", 0.0, 1.0},
        Scatter{"as much again between recordings", 1.0, 1.0},
        Scatter{"mostly between recordings", 3.0, 1.0}, Scatter{"uneven intervals", 1.0, 4.0}}) {
    std::printf("%s\n", scatter.words);
    for (const std::size_t count : {4U, 6U, 11U, 25U}) {
      std::printf("  %2zu earlier: size", count - 1);
      for (const double level : {0.05, 0.01}) {
        const double newest = share_below(level, scatter, count, 0.0, 0.0, kNewest);
        const double trend = share_below(level, scatter, count, 0.0, 0.0, kTrend);
        const double allowed = level + testing::binomial_allowance(level, kSets);
        EXPECT_LE(newest, allowed) << scatter.words << " " << count;
        EXPECT_LE(trend, allowed) << scatter.words << " " << count;
        std::printf(" %.1f %% and %.1f %% at %.0f %%;", 100.0 * newest, 100.0 * trend,
                    100.0 * level);
      }
      std::printf(" power at 1 %%, jump of");
      for (const double jump : {3.0, 5.0, 8.0}) {
        std::printf(" %.0f: %.0f %%", jump,
                    100.0 * share_below(0.01, scatter, count, jump, 0.0, kNewest));
      }
      std::printf("; trend of");
      for (const double slope : {3.0, 5.0, 8.0}) {
        std::printf(" %.0f: %.0f %%", slope,
                    100.0 * share_below(0.01, scatter, count, 0.0, slope, kTrend));
      }
      std::printf("\n");
    }
  }
}

// What a calibration says of a device's N and K: three replicates of a short recording, whose
// white noise is `factor` times as strong as the model's.
std::vector<DatedEstimate> calibrated(double factor, double time, std::uint64_t seed) {
  const Model truth =
      testing::model_of("WN(sigma2=" + std::to_string(factor * factor) + ") + RW(gamma2=1e-3)");
  const auto moments = testing::simulated_set(truth, {8192, 8192, 8192}, 1, seed);
  const Fit fit = infer(mugmwm(testing::freed(truth), moments, Weighting::kFull), moments);
  std::vector<DatedEstimate> out;
  for (const auto& derived : fit.derived) {
    const DerivedEstimate& one = derived.front();
    const double error = std::log(one.upper / one.lower) / (2.0 * normal_quantile(0.975));
    out.push_back({time, std::log(one.value), error * error});
  }
  return out;
}

TEST(ParameterHistoryTrial, SizeAndPowerOnFits) {
  constexpr std::size_t kHistory = 8;
  constexpr std::size_t kDevices = 400;
  const std::vector<double> factors = {1.0, 1.01, 1.02, 1.03, 1.05};  // of the last calibration
  struct Outcome {
    std::vector<double> n;  // p-values, one a factor
    double k = 1.0;
    double error = 0.0;  // standard error of log N
  };
  std::vector<Outcome> outcomes(kDevices);
  for_each_index(kDevices, [&](std::size_t d) {
    Estimates n;
    Estimates k;
    const std::uint64_t seed = kSeed + 100 * d;
    for (std::size_t i = 0; i < kHistory; ++i) {
      const auto one = calibrated(1.0, static_cast<double>(i), seed + i);
      n.push_back(one[0]);
      k.push_back(one[1]);
    }
    outcomes[d].error = std::sqrt(n.front().variance);
    for (const double factor : factors) {
      const auto last = calibrated(factor, static_cast<double>(kHistory), seed + kHistory);
      n.push_back(last[0]);
      outcomes[d].n.push_back(test_newest(n)->p_value);
      n.pop_back();
      if (factor > 1.0) continue;
      k.push_back(last[1]);
      outcomes[d].k = test_newest(k)->p_value;
      k.pop_back();
    }
  });
  const auto share = [&](double level, const auto& p) {
    double count = 0.0;
    for (const Outcome& one : outcomes) count += p(one) < level ? 1.0 : 0.0;
    return count / static_cast<double>(kDevices);
  };
  std::printf("N is known to %.2f %%; 8 earlier calibrations\n", 100.0 * outcomes[0].error);
  for (const double level : {0.05, 0.01}) {
    const double n = share(level, [](const Outcome& one) { return one.n[0]; });
    const double k = share(level, [](const Outcome& one) { return one.k; });
    std::printf("  size at %.0f %%: N %.1f %%, K %.1f %%\n", 100.0 * level, 100.0 * n, 100.0 * k);
    const double allowed = level + testing::binomial_allowance(level, kDevices);
    EXPECT_LE(n, allowed);
    EXPECT_LE(k, allowed);
  }
  for (std::size_t f = 1; f < factors.size(); ++f) {
    const double seen = share(0.01, [&](const Outcome& one) { return one.n[f]; });
    std::printf("  N grown by %.0f %%: alarm in %.0f %% at 1 %%\n", 100.0 * (factors[f] - 1.0),
                100.0 * seen);
  }
  EXPECT_GE(share(0.01, [&](const Outcome& one) { return one.n.back(); }), 0.9);
}

}  // namespace
}  // namespace imunoise
