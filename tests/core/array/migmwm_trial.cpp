// MiGMWM on the published structure: twelve series in three groups of four, one resonance (an AR2
// with complex roots) in all of them, an AR1 in each group, white noise of their own; 1,400 points.
// Coverage of the intervals, what the cross-covariances add to the variances alone, and what the
// likelihood adds to the moments.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "core/array/array_whittle.h"
#include "core/support/parallel.h"
#include "tests/core/array/simulated_array.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kSeed = 20261121;
constexpr std::size_t kRuns = 200;
constexpr std::size_t kSamples = 1400;

const ArrayLayout kLayout{12, {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2}};

Model written() { return parse_array_model("RES[all] + AR1[group] + WN", Hertz{1.0}).value(); }

ArrayModel truth() {
  ArrayModel out = expand(written(), kLayout);
  const auto set = [&](std::size_t latent, double power, std::vector<double> shape) {
    Latent& to = out.latents[latent];
    to.set_scalar(power);
    shape.insert(shape.begin(), 1.0);
    set_values(to.term.process, shape);
  };
  set(0, 0.2, {0.95, 0.3});
  set(1, 0.02, {0.98});
  set(2, 0.05, {0.95});
  set(3, 0.1, {0.9});
  for (std::size_t i = 0; i < 12; ++i) set(4 + i, 0.5 + 0.1 * static_cast<double>(i), {});
  return out;
}

struct Outcome {
  Eigen::ArrayXd error;    // relative
  Eigen::ArrayXd covered;  // 1 or 0
};

Outcome outcome_of(const ArrayFit& fit, const ArrayModel& model) {
  const auto n = static_cast<Eigen::Index>(fit.parameters.size());
  Outcome out{Eigen::ArrayXd(n), Eigen::ArrayXd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const ArrayParameter& parameter = fit.parameters[static_cast<std::size_t>(i)];
    const Latent& latent = model.latents[parameter.latent];
    const double value = parameter.parameter == 0
                             ? latent.scalar()
                             : values(latent.term.process)[parameter.parameter];
    out.error(i) = parameter.estimate.value / value - 1.0;
    out.covered(i) =
        parameter.estimate.lower <= value && value <= parameter.estimate.upper ? 1.0 : 0.0;
  }
  return out;
}

// Root mean square error in percent, and coverage in percent.
struct Quality {
  double rmse = 0.0;
  double coverage = 0.0;
};
Quality quality_of(const std::vector<Outcome>& runs, Eigen::Index parameter) {
  Quality out;
  for (const Outcome& one : runs) {
    out.rmse += one.error(parameter) * one.error(parameter) / kRuns;
    out.coverage += 100.0 * one.covered(parameter) / kRuns;
  }
  out.rmse = 100.0 * std::sqrt(out.rmse);
  return out;
}

TEST(Migmwm, IntervalsCoverOnThePublishedStructure) {
  const ArrayModel model = truth();
  std::array<std::vector<Outcome>, 3> ways;  // variances alone; with cross-covariances; likelihood
  for (auto& way : ways) way.resize(kRuns);
  for_each_index(kRuns, [&](std::size_t i) {
    const Eigen::MatrixXd samples = simulate(model, kSamples, kSeed, static_cast<std::uint32_t>(i));
    const WaveletCovariance measured = testing::moments_of(samples);
    ArrayOptions own;
    own.cross = false;
    ways[0][i] = outcome_of(fit_array(written(), kLayout, std::span(&measured, 1), own), model);
    const ArrayFit fit = fit_array(written(), kLayout, std::span(&measured, 1));
    ways[1][i] = outcome_of(fit, model);
    const CrossPower powers = testing::powers_of(samples);
    ways[2][i] = outcome_of(make_efficient(fit, std::span(&powers, 1)), model);
  });
  const Eigen::Index n = ways[2].front().error.size();
  ASSERT_EQ(n, 3 + 3 * 2 + 12);
  std::printf("seed %llu, %zu runs of 12 series of %zu points\n",
              static_cast<unsigned long long>(kSeed), kRuns, kSamples);
  std::printf("RMSE and coverage of: variances, with cross-covariances, likelihood\n");
  double mean = 0.0;
  for (Eigen::Index p = 0; p < n; ++p) {
    std::printf("| %2td |", p);
    for (const auto& way : ways) {
      const Quality quality = quality_of(way, p);
      std::printf(" %.2f %% | %.1f %% |", quality.rmse, quality.coverage);
    }
    std::printf("\n");
    const double covered = quality_of(ways[2], p).coverage / 100.0;
    mean += covered / static_cast<double>(n);
    EXPECT_NEAR(covered, 0.95, 4.0 * std::sqrt(0.95 * 0.05 / kRuns)) << p;
  }
  std::printf("mean coverage of the likelihood's intervals: %.1f %%\n", 100.0 * mean);
  EXPECT_GT(mean, 0.93);
  EXPECT_LT(mean, 0.97);
}

}  // namespace
}  // namespace imunoise
