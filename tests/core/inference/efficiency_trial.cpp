// How close each way of estimating comes to the Cramér-Rao bound: mean square errors over simulated
// recordings, over the bound of Whittle's information. Prints the table of docs/efficiency.md.
// Means suffer from the few runs in which one of two Markov noises all but vanishes, so that
// medians stand beside them, over the median that a normal error at the bound would have.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <numeric>

#include "core/estimate/whittle.h"
#include "core/process/parameter_scale.h"
#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"
#include "study/figure/svg.h"
#include "study/report/figures/interval_figure.h"
#include "tests/core/inference/simulated_sets.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kSeed = 77'000;
constexpr std::size_t kRuns = 200;
constexpr std::size_t kSamples = std::size_t{1} << 15U;
constexpr double kMedianOfSquare = 0.4549;  // of a standard normal number

struct Way {
  const char* name;
  Weighting weighting;
  int per_octave;
};
constexpr Way kWays[] = {{"diag 1", Weighting::kDiagonal, 1}, {"diag 2", Weighting::kDiagonal, 2},
                         {"diag 4", Weighting::kDiagonal, 4}, {"full 1", Weighting::kFull, 1},
                         {"full 2", Weighting::kFull, 2},     {"full 4", Weighting::kFull, 4}};
constexpr std::size_t kDefault = 3;              // full weights, one scale an octave
constexpr std::size_t kStep = std::size(kWays);  // the Whittle step after it
constexpr std::size_t kAll = kStep + 1;

// Error on the scale on which an estimate is close to normal: relative for a power.
double error_of(const Term& truth, const Term& found, std::size_t parameter) {
  const double a = values(truth.process)[parameter];
  const double b = values(found.process)[parameter];
  if (parameter == 0) return b / a - 1.0;
  const ParameterScale scale(parameters(truth.process)[parameter], parameter);
  return scale.to_scale(b) - scale.to_scale(a);
}

// The bound of every parameter, as a variance on that scale.
std::vector<double> bounds_of(const Model& truth) {
  const BandedPower bands = bands_of(kSamples, testing::kTrialRate);
  std::vector<Eigen::Index> columns(parameter_count(truth));
  std::iota(columns.begin(), columns.end(), 0);
  const Eigen::MatrixXd inverse =
      pseudo_inverse(whittle_information(truth, std::span(&bands, 1), columns)).matrix;
  std::vector<double> out;
  for (const Term& term : truth.terms) {
    const std::vector<double> v = values(term.process);
    for (std::size_t p = 0; p < v.size(); ++p) {
      const auto at = static_cast<Eigen::Index>(out.size());
      const double slope = ParameterScale(parameters(term.process)[p], p).slope(v[p]);
      out.push_back(inverse(at, at) / (slope * slope));
    }
  }
  return out;
}

double mean_square(const std::vector<double>& errors) {
  return std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0) /
         static_cast<double>(errors.size());
}
double median_square(std::vector<double> errors) {
  for (double& e : errors) e *= e;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

// Of all models: moments at the default and, at the end of the whisker, after the Whittle step.
std::vector<report::IntervalRow>& figure_rows() {
  static std::vector<report::IntervalRow> rows;
  return rows;
}

// The goal is the bound within 10 % for every parameter, at the default or, where that is not
// enough, after the Whittle step that the program then offers.
constexpr double kGoal = 1.1;

struct Case {
  const char* model;
  bool needs_step = false;
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.model; }

class Efficiency : public ::testing::TestWithParam<Case> {};

TEST_P(Efficiency, AgainstTheCramerRaoBound) {
  const auto& [name, needs_step] = GetParam();
  const Model truth = testing::model_of(name);
  const Model open = testing::freed(truth);
  const std::vector<double> bounds = bounds_of(truth);
  // errors[way][parameter][run]
  std::vector<std::vector<std::vector<double>>> errors(
      kAll, std::vector<std::vector<double>>(bounds.size(), std::vector<double>(kRuns)));
  const auto keep = [&](std::size_t way, std::size_t run, const Model& found) {
    std::size_t at = 0;
    for (std::size_t t = 0; t < truth.terms.size(); ++t) {
      for (std::size_t p = 0; p < truth.terms[t].given.size(); ++p)
        errors[way][at++][run] = error_of(truth.terms[t], found.terms[t], p);
    }
  };
  for_each_index(kRuns, [&](std::size_t i) {
    const std::vector<double> x = simulate(truth, kSamples, kSeed + i, 0);
    const Signal signal(std::span<const double>(x), testing::kTrialRate);
    for (std::size_t w = 0; w < std::size(kWays); ++w) {
      const WaveletVariance moments =
          wavelet_variance(signal, Scales::for_samples(kSamples, kWays[w].per_octave));
      const Model found = mugmwm(open, std::span(&moments, 1), kWays[w].weighting).model;
      keep(w, i, found);
      if (w != kDefault) continue;
      const BandedPower bands = banded_power(signal);
      keep(kStep, i, whittle(found, std::span(&bands, 1)).model);
    }
  });
  std::printf("| %s, T = %zu, %zu runs | error at the bound | |", name, kSamples, kRuns);
  for (const Way& way : kWays) std::printf(" %s |", way.name);
  std::printf(" Whittle step |\n");
  std::size_t at = 0;
  for (const Term& term : truth.terms) {
    for (const ParameterInfo& about : parameters(term.process)) {
      std::vector<double> means;
      std::vector<double> medians;
      for (const auto& way : errors) {
        means.push_back(mean_square(way[at]) / bounds[at]);
        medians.push_back(median_square(way[at]) / (kMedianOfSquare * bounds[at]));
      }
      const auto row = [&](const char* which, const std::vector<double>& ratios) {
        std::printf("| %s %s | %.2g | %s |", info(term.process).name.data(), about.name.c_str(),
                    std::sqrt(bounds[at]), which);
        for (const double one : ratios) std::printf(" %.2f |", one);
        std::printf("\n");
      };
      figure_rows().push_back({fmt::format("{} of {}", about.name, print(open)), medians[kDefault],
                               std::min(medians[kStep], medians[kDefault]),
                               std::max(medians[kStep], medians[kDefault]),
                               medians[kDefault] > 1.25});
      row("mean", means);
      row("median", medians);
      // The median of n squares of normal numbers scatters by 1.36 / 0.4549 / √n, relatively: the
      // density of a squared normal at its median is 0.471.
      const double scatter = 0.5 / (0.471 * kMedianOfSquare * std::sqrt(kRuns));
      const double most = kGoal + 3.3 * scatter;
      EXPECT_LT(medians[kStep], most) << name << " " << about.name << ", Whittle step";
      if (!needs_step) {
        EXPECT_LT(medians[kDefault], most) << name << " " << about.name << ", default";
        const double best = *std::min_element(medians.begin(), medians.begin() + kStep);
        EXPECT_LT(medians[kDefault] / best, 1.6) << name << " " << about.name << ", default";
      }
      ++at;
    }
  }
  auto drawn = report::interval_figure(
      "Median square error over the Cramér-Rao bound",
      "median square error over that of a normal error at the bound", "", figure_rows(), 1.0);
  drawn->subtitle =
      "Dots: moments with full weights at one scale an octave; the line leads to the Whittle step";
  std::ofstream("efficiency.svg") << figure::svg(*drawn);
}

INSTANTIATE_TEST_SUITE_P(
    Models, Efficiency,
    ::testing::Values(  // a dyadic scale is an octave wide, a resonance a few per cent
        Case{"WN(sigma2=1) + RW(gamma2=1e-4)"}, Case{"QN(q2=4) + WN(sigma2=1) + RW(gamma2=1e-4)"},
        Case{"WN(sigma2=1) + FN(b2=0.05)"}, Case{"AR1(sigma2=0.05, phi=0.97) + WN(sigma2=1)"},
        Case{"AR1(sigma2=0.2, phi=0.9) + WN(sigma2=1) + RW(gamma2=1e-4)"},
        Case{"AR1(sigma2=0.01, phi=0.99501) + AR1(sigma2=0.1, phi=0.96079) + WN(sigma2=1)"},
        Case{"RES(sigma2=0.05, r=0.97, omega=0.8) + WN(sigma2=1) + RW(gamma2=1e-4)", true},
        Case{"WN(sigma2=1) + RW(gamma2=1e-5) + DR(omega2=4e-9)"}));

// φ of AR1 + WN over replicates, by one model for all and by the average of one each.
struct Memory {
  double pooled;
  double averaged;
};
Memory memory_of(std::span<const WaveletVariance> replicates) {
  const Model open = testing::model_of("AR1 + WN");
  const auto phi = [](const Model& model) { return values(model.terms[0].process)[1]; };
  return {phi(mugmwm(open, replicates, Weighting::kFull).model),
          phi(agmwm(open, replicates, Weighting::kFull).average.model)};
}

// Where replicates differ, pooling is not averaging: theory's moments, which have no noise, predict
// by how much (Jensen's inequality). Where they do not, pooling is the more precise.
TEST(PoolingAndAveraging, DifferAsPredicted) {
  constexpr std::size_t kSets = 200;
  const Model fast = testing::model_of("AR1(sigma2=0.05, phi=0.98) + WN(sigma2=1)");
  const Model slow = testing::model_of("AR1(sigma2=0.05, phi=0.995) + WN(sigma2=1)");
  for (const bool alike : {false, true}) {
    const std::size_t samples = alike ? std::size_t{1} << 11U : std::size_t{1} << 16U;
    const std::array truths = {fast, alike ? fast : slow};
    const std::vector<WaveletVariance> exact = {testing::theory(truths[0], samples),
                                                testing::theory(truths[1], samples)};
    const Memory predicted = memory_of(exact);
    std::vector<Memory> found(kSets);
    for_each_index(kSets, [&](std::size_t i) {
      std::vector<WaveletVariance> replicates;
      for (std::size_t k = 0; k < 4; ++k) {
        replicates.push_back(
            testing::simulated_set(truths[k % 2], {samples}, 1, kSeed + 10'000 + 4 * i + k)[0]);
      }
      found[i] = memory_of(replicates);
    });
    const auto describe = [&](const char* name, double Memory::*what) {
      double mean = 0.0;
      double square = 0.0;
      for (const Memory& one : found) {
        mean += one.*what / kSets;
        square += (one.*what - predicted.*what) * (one.*what - predicted.*what) / kSets;
      }
      const double error = std::sqrt(
          std::max(0.0, square - (mean - predicted.*what) * (mean - predicted.*what)) / kSets);
      std::printf("| %s | %s | %.5f | %.5f ± %.5f | %.5f |\n",
                  alike ? "alike, T = 2048" : "φ = 0.98 and 0.995, T = 65536", name,
                  predicted.*what, mean, error, std::sqrt(square));
      if (!alike) {
        EXPECT_NEAR(mean, predicted.*what, 4.0 * error) << name;
      }
      return square;
    };
    std::printf("| four replicates of AR1 + WN | | φ predicted | φ measured | RMSE |\n");
    const double pooled = describe("MuGMWM", &Memory::pooled);
    const double averaged = describe("AGMWM", &Memory::averaged);
    if (alike) {
      EXPECT_LT(pooled, averaged);
    }
  }
}

}  // namespace
}  // namespace imunoise
