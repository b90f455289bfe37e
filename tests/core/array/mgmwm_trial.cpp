// MGMWM against Vaccaro & Zaki's GLS(2) on three sensors with correlated random walks (Xu et al.
// 2019, simulation study): mean squared error, bias and coverage of every parameter.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "core/array/array_estimate.h"
#include "core/support/parallel.h"
#include "study/figure/svg.h"
#include "study/report/figures/interval_figure.h"
#include "tests/core/array/simulated_array.h"
#include "tests/core/array/vaccaro_zaki.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kSeed = 20261121;
constexpr std::size_t kRuns = 500;
constexpr std::size_t kSamples = 100'000;
constexpr std::size_t kParameters = 9;

struct Errors {
  Eigen::Array<double, kParameters, 1> ours;
  Eigen::Array<double, kParameters, 1> theirs;
  Eigen::Array<double, kParameters, 1> covered;
};

// The published powers; the unit of the random walk's is not stated with them.
ArrayModel truth_of(double walk_unit) {
  ArrayModel out = expand(parse_array_model("RW[corr] + WN", Hertz{1.0}).value(), {3, {}});
  out.latents[0].power << 0.0119, -0.0004, 0.0048,  //
      -0.0004, 0.0220, 0.0093,                      //
      0.0048, 0.0093, 0.1628;
  out.latents[0].power *= walk_unit;
  const Eigen::Vector3d white(0.1010e-3, 0.0712e-3, 0.0490e-3);
  for (Eigen::Index i = 0; i < 3; ++i)
    out.latents[static_cast<std::size_t>(1 + i)].set_scalar(white(i));
  return out;
}

Errors run(const ArrayModel& truth, std::uint32_t set) {
  Errors out;
  const WaveletCovariance measured = testing::simulated_moments(truth, kSamples, kSeed, set);
  const auto data = testing::simulated_array(truth, kSamples, kSeed, set);
  const ArrayFit fit = fit_array(parse_array_model("RW[corr] + WN", Hertz{1.0}).value(), {3, {}},
                                 std::span(&measured, 1));
  const testing::VaccaroZaki other = testing::VaccaroZakiEstimator(2)(data);
  for (std::size_t p = 0; p < kParameters; ++p) {
    const auto at = static_cast<Eigen::Index>(p);
    const ArrayParameter& parameter = fit.parameters[p];
    const double value = truth.latents[parameter.latent].power(parameter.row, parameter.column);
    const bool walk = parameter.latent == 0;
    out.ours(at) = parameter.estimate.value / value - 1.0;
    out.theirs(at) =
        (walk ? other.q(parameter.row, parameter.column) : other.r(parameter.row)) / value - 1.0;
    const bool covered = parameter.estimate.lower <= value && value <= parameter.estimate.upper;
    out.covered(at) = covered ? 1.0 : 0.0;
  }
  return out;
}

class Mgmwm : public ::testing::TestWithParam<double> {};

TEST_P(Mgmwm, BeatsGls2ForEveryParameter) {
  const ArrayModel truth = truth_of(GetParam());
  std::vector<Errors> runs(kRuns);
  for_each_index(kRuns,
                 [&](std::size_t i) { runs[i] = run(truth, static_cast<std::uint32_t>(i)); });
  Errors mean{};
  Errors squares{};
  mean.ours.setZero(), mean.theirs.setZero(), mean.covered.setZero();
  squares.ours.setZero(), squares.theirs.setZero();
  for (const Errors& one : runs) {
    mean.ours += one.ours / kRuns;
    mean.theirs += one.theirs / kRuns;
    mean.covered += one.covered / kRuns;
    squares.ours += one.ours.square() / kRuns;
    squares.theirs += one.theirs.square() / kRuns;
  }
  std::printf("seed %llu, %zu runs of %zu samples, random walk in units of %g\n",
              static_cast<unsigned long long>(kSeed), kRuns, kSamples, GetParam());
  std::printf("parameter   RMSE ours  GLS(2)   MSE ratio   bias ours  GLS(2)   coverage\n");
  std::vector<report::IntervalRow> rows;
  constexpr std::array<const char*, kParameters> kNames = {
      "RW 11", "RW 12", "RW 13", "RW 22", "RW 23", "RW 33", "WN 1", "WN 2", "WN 3"};
  for (std::size_t p = 0; p < kParameters; ++p) {
    const auto at = static_cast<Eigen::Index>(p);
    std::printf("%-10s %8.2f %% %7.2f %%   %8.3f  %8.2f %% %6.2f %%   %6.1f %%\n", kNames[p],
                100.0 * std::sqrt(squares.ours(at)), 100.0 * std::sqrt(squares.theirs(at)),
                squares.ours(at) / squares.theirs(at), 100.0 * mean.ours(at),
                100.0 * mean.theirs(at), 100.0 * mean.covered(at));
    // The ratio's error from the runs, which both estimators share.
    const double ratio = squares.ours(at) / squares.theirs(at);
    double scatter = 0.0;
    for (const Errors& one : runs) {
      const double off = one.ours(at) * one.ours(at) - ratio * one.theirs(at) * one.theirs(at);
      scatter += off * off / (kRuns * kRuns);
    }
    const double reach = 1.96 * std::sqrt(scatter) / squares.theirs(at);
    rows.push_back({kNames[p], ratio, ratio - reach, ratio + reach, ratio + reach > 1.0});
    EXPECT_LT(squares.ours(at), squares.theirs(at)) << kNames[p];
    // 95 % within four binomial standard errors of 500 runs.
    EXPECT_NEAR(mean.covered(at), 0.95, 4.0 * std::sqrt(0.95 * 0.05 / kRuns)) << kNames[p];
  }
  const std::string file = fmt::format("mgmwm-against-gls2-{:g}.svg", GetParam());
  auto drawn = report::interval_figure(
      fmt::format("MGMWM against Vaccaro and Zaki's GLS(2), random walk in units of {:g}",
                  GetParam()),
      "mean square error over that of GLS(2)", "", rows, 1.0);
  drawn->subtitle = fmt::format(
      "{} runs of three sensors with {} samples; 95 % intervals of the ratio", kRuns, kSamples);
  std::ofstream(file) << figure::svg(*drawn);
  std::printf("drawn in %s\n", file.c_str());
}

INSTANTIATE_TEST_SUITE_P(WalkUnits, Mgmwm, ::testing::Values(1e-6, 1e-9));

}  // namespace
}  // namespace imunoise
