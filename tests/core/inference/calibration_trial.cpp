// Size of the test of fit and coverage of the intervals, over many simulated recordings.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <map>

#include "core/support/parallel.h"
#include "core/support/distributions.h"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#include "tests/core/inference/simulated_sets.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kSeed = 20'250;
std::size_t sets() { const char* n = std::getenv("SETS"); return n ? std::atoi(n) : 1000; }

struct Case {
  const char* name;
  const char* truth;
};
const std::vector<Case> kCases = {
    {"WN+RW", "WN(sigma2=1) + RW(gamma2=1e-3)"},
    {"AR1+WN", "AR1(sigma2=0.05, phi=0.97) + WN(sigma2=1)"},
    {"WN+QN+RW", "WN(sigma2=1) + QN(q2=3) + RW(gamma2=1e-3)"},
    {"AR1+WN+RW", "AR1(sigma2=0.2, phi=0.9) + WN(sigma2=1) + RW(gamma2=1e-4)"}};

TEST(X, Table) {
  const std::size_t n = sets();
  const int per_octave = std::getenv("PO") ? std::atoi(std::getenv("PO")) : 1;
  const std::size_t T = std::getenv("T") ? std::atoi(std::getenv("T")) : 16384;
  const char* only = std::getenv("ONLY");
  for (const Case& c : kCases) {
    if (only && std::string(only) != c.name) continue;
    const Model truth = testing::model_of(c.truth);
    const Model open = testing::freed(truth);
    for (const std::size_t replicates : {1, 3}) {
      for (const Weighting w : {Weighting::kFull, Weighting::kDiagonal}) {
        std::vector<Fit> fits(n);
        for_each_index(n, [&](std::size_t i) {
          const auto moments = testing::simulated_set(truth, std::vector<std::size_t>(replicates, T), per_octave, kSeed + i);
          fits[i] = infer(mugmwm(open, moments, w), moments);
        });
        double r5 = 0, r1 = 0, stat = 0, df = 0;
        std::map<int,int> dfs;
        for (const Fit& f : fits) {
          r5 += f.goodness.p_value < 0.05; r1 += f.goodness.p_value < 0.01;
          stat += f.goodness.statistic; df += f.goodness.degrees_of_freedom; dfs[f.goodness.degrees_of_freedom]++;
        }
        std::printf("%-10s K=%zu %s  size %.2f%% %.2f%%  J %.2f df %.2f ", c.name, replicates, w == Weighting::kFull ? "full" : "diag",
                    100 * r5 / n, 100 * r1 / n, stat / n, df / n);
        for (auto& [d, k] : dfs) std::printf(" %d:%d", d, k);
        std::printf("\n     coverage");
        for (std::size_t t = 0; t < truth.terms.size(); ++t) {
          const auto v = values(truth.terms[t].process);
          const auto about = parameters(truth.terms[t].process);
          for (std::size_t p = 0; p < v.size(); ++p) {
            int in = 0, low = 0, high = 0, obs = 0;
            for (const Fit& f : fits) {
              const auto& e = f.parameters[t][p];
              in += e.lower <= v[p] && v[p] <= e.upper; low += v[p] < e.lower; high += v[p] > e.upper;
              obs += e.observability == Observability::kObserved;
            }
            std::printf("  %s.%s %.1f(<%.1f >%.1f o%.0f)", std::string(info(truth.terms[t].process).name).c_str(), about[p].name.c_str(), 100.0 * in / n, 100.0 * low / n, 100.0 * high / n, 100.0 * obs / n);
          }
          for (const DerivedQuantity& q : derived(truth.terms[t].process, testing::kTrialRate)) {
            int in = 0;
            for (const Fit& f : fits) for (const auto& e : f.derived[t]) if (e.coefficient == q.coefficient) in += e.lower <= q.value && q.value <= e.upper;
            std::printf("  [%s %.1f]", std::string(coefficient_units(q.coefficient, Quantity::kUnknown).symbol).c_str(), 100.0 * in / n);
          }
        }
        std::printf("\n"); std::fflush(stdout);
      }
    }
  }
}

}  // namespace
}  // namespace imunoise
