// MiGMWM on the published structure: twelve series in three groups of four, one resonance (an AR2
// with complex roots) in all of them, an AR1 in each group, white noise of their own; 1,400 points.
// Coverage of the intervals, and what the cross-covariances add to the variances alone.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "core/array/array_estimate.h"
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

TEST(Migmwm, IntervalsCoverOnThePublishedStructure) {
  const ArrayModel model = truth();
  std::vector<Outcome> with(kRuns);
  std::vector<Outcome> without(kRuns);
  for_each_index(kRuns, [&](std::size_t i) {
    const WaveletCovariance measured =
        testing::simulated_moments(model, kSamples, kSeed, static_cast<std::uint32_t>(i), 1);
    const auto one = std::span(&measured, 1);
    with[i] = outcome_of(fit_array(written(), kLayout, one), model);
    ArrayOptions own;
    own.cross = false;
    without[i] = outcome_of(fit_array(written(), kLayout, one, own), model);
  });
  const Eigen::Index n = with.front().error.size();
  ASSERT_EQ(n, 3 + 3 * 2 + 12);
  std::printf("seed %llu, %zu runs of 12 series of %zu points\n",
              static_cast<unsigned long long>(kSeed), kRuns, kSamples);
  std::printf("parameter   RMSE with cross-covariances, without   coverage with, without\n");
  double all = 0.0;
  for (Eigen::Index p = 0; p < n; ++p) {
    std::array<double, 2> squares{};
    std::array<double, 2> covered{};
    for (std::size_t i = 0; i < kRuns; ++i) {
      squares[0] += with[i].error(p) * with[i].error(p) / kRuns;
      squares[1] += without[i].error(p) * without[i].error(p) / kRuns;
      covered[0] += with[i].covered(p) / kRuns;
      covered[1] += without[i].covered(p) / kRuns;
    }
    std::printf("%2td   %8.2f %%  %8.2f %%   %6.1f %%  %6.1f %%\n", p,
                100.0 * std::sqrt(squares[0]), 100.0 * std::sqrt(squares[1]), 100.0 * covered[0],
                100.0 * covered[1]);
    all += covered[0] / static_cast<double>(n);
    EXPECT_NEAR(covered[0], 0.95, 4.0 * std::sqrt(0.95 * 0.05 / kRuns)) << p;
  }
  std::printf("mean coverage with cross-covariances: %.1f %%\n", 100.0 * all);
  EXPECT_GT(all, 0.93);
  EXPECT_LT(all, 0.97);
}

}  // namespace
}  // namespace imunoise
