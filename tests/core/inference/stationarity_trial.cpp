// Size and power of the tests of near-stationarity, on simulated samples.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/inference/near_stationarity.h"
#include "core/support/parallel.h"
#include "tests/core/inference/simulated_sets.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kSeed = 20261121;
constexpr std::size_t kSets = 1000;

struct Case {
  const char* name;
  const char* truth;
  std::size_t samples;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

class Size : public ::testing::TestWithParam<Case> {};

// Both tests reject a true model at 5 % in 5 % of all sets, within what 1,000 sets allow; the issue
// of the tool asks for 4 to 6 %.
TEST_P(Size, IsNominal) {
  const Case& c = GetParam();
  const Model truth = testing::model_of(c.truth);
  const Model open = testing::freed(truth);
  const std::vector<std::size_t> lengths(6, c.samples);
  std::vector<int> misfit(kSets);
  std::vector<int> heterogeneity(kSets);
  for_each_index(kSets, [&](std::size_t i) {
    const auto moments = testing::simulated_set(truth, lengths, 1, kSeed + i);
    const NearStationarity result = near_stationarity(open, moments);
    misfit[i] = result.misfit.p_value() < 0.05 ? 1 : 0;
    heterogeneity[i] = result.heterogeneity.p_value() < 0.05 ? 1 : 0;
  });
  const auto share = [](const std::vector<int>& all) {
    double sum = 0.0;
    for (const int one : all) sum += one;
    return sum / static_cast<double>(all.size());
  };
  std::printf("%-16s misfit %.1f %%, heterogeneity %.1f %% of %zu sets (seed %llu)\n", c.name,
              100.0 * share(misfit), 100.0 * share(heterogeneity), kSets,
              static_cast<unsigned long long>(kSeed));
  EXPECT_NEAR(share(misfit), 0.05, testing::binomial_allowance(0.05, kSets));
  EXPECT_NEAR(share(heterogeneity), 0.05, testing::binomial_allowance(0.05, kSets));
}

INSTANTIATE_TEST_SUITE_P(
    Models, Size,
    ::testing::Values(
        Case{"WN+RW", "WN(sigma2=1) + RW(gamma2=1e-5)", 16384},
        Case{"AR1+WN", "AR1(sigma2=0.01, phi=0.98) + WN(sigma2=1)", 16384},
        Case{"AR1+WN weak", "AR1(sigma2=4e-4, phi=0.99) + WN(sigma2=1)", 16384},
        Case{"WN+QN+RW", "WN(sigma2=1) + QN(q2=2) + RW(gamma2=1e-5)", 16384},
        Case{"AR1+WN+RW", "AR1(sigma2=0.1, phi=0.9) + WN(sigma2=1) + RW(gamma2=1e-5)", 32768},
        Case{"2*AR1+WN", "AR1(sigma2=0.2, phi=0.8) + AR1(sigma2=1e-3, phi=0.998) + WN(sigma2=1)",
             65536}));

}  // namespace
}  // namespace imunoise
