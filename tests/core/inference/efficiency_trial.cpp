// Which weights and how many scales an octave estimate best: mean square errors over simulated recordings.
// Prints a table; what must hold is only that the default is never far from the best.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "core/support/parallel.h"
#include "tests/core/inference/simulated_sets.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kSeed = 77'000;
constexpr std::size_t kRuns = 150;
constexpr std::size_t kSamples = std::size_t{1} << 15U;

// Relative error of a power, error of the logarithm of a correlation time (its law has a long tail).
double squared_error(const Process& truth, const Process& found, std::size_t parameter) {
  const double a = values(truth)[parameter];
  const double b = values(found)[parameter];
  const auto time = [](double phi) { return -1.0 / std::log(std::clamp(phi, 1e-3, 1.0 - 1e-9)); };
  const double error = parameter == 0 ? b / a - 1.0 : std::log(time(b) / time(a));
  return error * error;
}

struct Way {
  const char* name;
  Weighting weighting;
  int per_octave;
};
constexpr Way kWays[] = {{"diag 1", Weighting::kDiagonal, 1}, {"diag 2", Weighting::kDiagonal, 2},
                         {"diag 4", Weighting::kDiagonal, 4}, {"full 1", Weighting::kFull, 1},
                         {"full 2", Weighting::kFull, 2},     {"full 4", Weighting::kFull, 4}};
constexpr std::size_t kDefault = 3;  // full weights, one scale an octave

class Efficiency : public ::testing::TestWithParam<const char*> {};

TEST_P(Efficiency, DefaultIsNotFarFromTheBest) {
  const Model truth = testing::model_of(GetParam());
  const std::size_t count = parameter_count(truth);
  std::vector<std::vector<double>> mean(std::size(kWays), std::vector<double>(count));
  for (std::size_t w = 0; w < std::size(kWays); ++w) {
    std::vector<std::vector<double>> errors(kRuns);
    for_each_index(kRuns, [&](std::size_t i) {
      const auto moments = testing::simulated_set(truth, {kSamples}, kWays[w].per_octave, kSeed + i);
      const Model found = mugmwm(testing::freed(truth), moments, kWays[w].weighting).model;
      for (std::size_t t = 0; t < truth.terms.size(); ++t) {
        for (std::size_t p = 0; p < truth.terms[t].given.size(); ++p) {
          errors[i].push_back(squared_error(truth.terms[t].process, found.terms[t].process, p));
        }
      }
    });
    for (const std::vector<double>& one : errors) {
      for (std::size_t p = 0; p < count; ++p) mean[w][p] += one[p] / static_cast<double>(kRuns);
    }
  }
  std::printf("%s, T = %zu, %zu runs, seeds from %llu: mean square errors relative to the best\n", GetParam(),
              kSamples, kRuns, static_cast<unsigned long long>(kSeed));
  std::printf("%-14s", "");
  for (const Way& way : kWays) std::printf("%8s", way.name);
  std::printf("   rms error of the best\n");
  std::size_t p = 0;
  for (const Term& term : truth.terms) {
    for (const ParameterInfo& about : parameters(term.process)) {
      double best = mean[0][p];
      for (const auto& way : mean) best = std::min(best, way[p]);
      std::printf("%-14s", (std::string(info(term.process).name) + " " + about.name).c_str());
      for (const auto& way : mean) std::printf("%8.2f", way[p] / best);
      std::printf("   %.4f\n", std::sqrt(best));
      EXPECT_LT(mean[kDefault][p] / best, 1.6) << GetParam() << " " << about.name;
      ++p;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Efficiency,
                         ::testing::Values("WN(sigma2=1) + RW(gamma2=1e-4)",
                                           "AR1(sigma2=0.05, phi=0.97) + WN(sigma2=1)",
                                           "AR1(sigma2=0.01, phi=0.99501) + AR1(sigma2=0.1, phi=0.96079) + WN(sigma2=1)",
                                           "AR1(sigma2=0.2, phi=0.9) + WN(sigma2=1) + RW(gamma2=1e-4)"));

}  // namespace
}  // namespace imunoise
