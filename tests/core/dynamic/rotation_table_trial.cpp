// The gyro on the rotation table, many times: do intervals cover, do the tests keep their size, and
// what is gained by tying the bins together?

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include "core/support/parallel.h"
#include "study/figure/svg.h"
#include "study/report/figures/covariate_figure.h"
#include "tests/core/dynamic/rotation_table.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kSeed = 20261121;
constexpr std::size_t kSets = 300;
constexpr std::size_t kSamples = 1U << 15U;  // of each dwell: five and a half minutes
constexpr double kShare = 1.0 / static_cast<double>(kSets);
// Four standard errors of a share of kSets: chance alone breaks one such limit in 16,000.
const double kAllowance = 4.0 * std::sqrt(0.95 * 0.05 * kShare);

bool covers(const ParameterEstimate& estimate, double truth) {
  return estimate.lower <= truth && truth <= estimate.upper;
}

// Error and coverage of one estimate of a power, together and by itself.
struct Compared {
  double tied_squares = 0.0;  // relative
  double own_squares = 0.0;
  double tied_covers = 0.0;
  double own_covers = 0.0;

  void add(const ParameterEstimate& tied, const ParameterEstimate& own, double truth) {
    tied_squares += kShare * std::pow(tied.value / truth - 1.0, 2);
    own_squares += kShare * std::pow(own.value / truth - 1.0, 2);
    tied_covers += covers(tied, truth) ? kShare : 0.0;
    own_covers += covers(own, truth) ? kShare : 0.0;
  }
};

// The first coefficient of a term over the rate, as a picture for the guides (SVG).
void draw(const DynamicFit& fit, std::size_t term, const char* file) {
  const Coefficient coefficient = estimates_at(fit, 30.0)[term].derived[0].coefficient;
  const CoefficientUnits units = coefficient_units(coefficient, Quantity::kAngularRate);
  const auto point = [&](double rate, const DerivedEstimate& from) {
    return report::CovariateValue{rate, from.value * units.to_datasheet,
                                  from.lower * units.to_datasheet, from.upper * units.to_datasheet};
  };
  report::CovariateValues chart;
  chart.title = std::string(units.title) + " on a simulated rotation table";
  chart.covariate_title = "rate, °/s";
  chart.value_title = std::string(units.symbol) + ", " + units.datasheet;
  chart.caption =
      "Line: all dwells fitted together, in its 95 % band. Circles: each dwell by itself, with its "
      "interval; grey where only the upper end means something.";
  for (double rate = 30.0; rate <= 390.0; rate += 6.0) {
    chart.curve.push_back(point(rate, estimates_at(fit, rate)[term].derived[0]));
  }
  const std::vector<double> rates = testing::table_rates();
  for (std::size_t b = 0; b < rates.size(); ++b) {
    chart.points.push_back(point(rates[b], fit.separate[b]->derived[term][0]));
  }
  std::ofstream(file) << figure::svg(*report::covariate_figure(chart));
  std::printf("drawn in %s\n", file);
}

TEST(RotationTableTrial, IntervalsCoverAndTyingPays) {
  const std::vector<double> rates = testing::table_rates();
  const Model open = parse_dynamic_model(testing::kTableModel, testing::kTableRate).value();
  std::vector<DynamicFit> fits(kSets);
  for_each_index(kSets, [&](std::size_t i) {
    fits[i] =
        fit_dynamic(open, testing::simulated_table(kSamples, kSeed, static_cast<std::uint32_t>(i)));
  });
  std::printf("seed %llu, %zu sets of %zu dwells of %zu samples\n",
              static_cast<unsigned long long>(kSeed), kSets, rates.size(), kSamples);
  draw(fits[0], 0, "dynamic-quantisation.svg");
  draw(fits[0], 1, "dynamic-random-walk.svg");
  std::printf("rate   power  relative RMSE tied, alone   coverage tied, alone\n");
  for (std::size_t bin = 0; bin < rates.size(); ++bin) {
    const double rate = rates[bin];
    const Model truth = testing::table_truth(rate);
    for (std::size_t t = 0; t < 2; ++t) {
      Compared power;
      for (const DynamicFit& fit : fits) {
        power.add(estimates_at(fit, rate)[t].parameters[0], fit.separate[bin]->parameters[t][0],
                  values(truth.terms[t].process)[0]);
      }
      std::printf("%4.0f   %-6s %10.3g %% %10.3g %%   %6.1f %% %6.1f %%\n", rate,
                  t == 0 ? "Q2" : "sigma2", 100.0 * std::sqrt(power.tied_squares),
                  100.0 * std::sqrt(power.own_squares), 100.0 * power.tied_covers,
                  100.0 * power.own_covers);
      EXPECT_NEAR(power.tied_covers, 0.95, kAllowance) << rate << ", term " << t;
      EXPECT_LT(power.tied_squares, power.own_squares) << rate << ", term " << t;
    }
  }
  const std::array<double, 2> slopes = {std::log(1e-4) / 360.0,
                                        2.0 * std::log(0.439 / 0.146) / 360.0};
  std::array<double, 2> covered{};
  double misfit = 0.0;
  double links = 0.0;
  for (const DynamicFit& fit : fits) {
    for (std::size_t t = 0; t < 2; ++t) {
      const TrendEstimate& trend = fit.trends[t];
      covered[t] += trend.lower <= slopes[t] && slopes[t] <= trend.upper ? kShare : 0.0;
    }
    misfit += fit.misfit.p_value <= 0.05 ? kShare : 0.0;
    links += fit.links.p_value <= 0.05 ? kShare : 0.0;
  }
  std::printf("slopes covered: Q2 %.1f %%, sigma2 %.1f %%\n", 100.0 * covered[0],
              100.0 * covered[1]);
  std::printf("rejected at 5 %%: misfit %.1f %%, links %.1f %%\n", 100.0 * misfit, 100.0 * links);
  EXPECT_NEAR(covered[0], 0.95, kAllowance);
  EXPECT_NEAR(covered[1], 0.95, kAllowance);
  EXPECT_NEAR(misfit, 0.05, kAllowance);
  EXPECT_NEAR(links, 0.05, kAllowance);
}

// Noise that follows nothing, with a shape to search: the tests of the trends keep their size.
TEST(RotationTableTrial, TestsOfTrendsKeepTheirSize) {
  constexpr std::size_t kShort = 1U << 13U;
  const Model truth =
      parse_model("AR1(sigma2=0.01, phi=0.97) + WN(sigma2=1)", testing::kTableRate).value();
  const Model open =
      parse_dynamic_model("AR1(sigma2~, phi~) + WN(sigma2~linear)", testing::kTableRate).value();
  std::vector<DynamicFit> fits(kSets);
  for_each_index(kSets, [&](std::size_t i) {
    std::vector<CovariateBin> bins;
    for (std::uint32_t b = 0; b < 5; ++b) {
      const std::vector<double> x =
          simulate(truth, kShort, kSeed, 100 * static_cast<std::uint32_t>(i) + b);
      bins.push_back({10.0 * b,
                      {wavelet_variance(Signal(std::span<const double>(x), testing::kTableRate),
                                        Scales::for_samples(kShort))}});
    }
    fits[i] = fit_dynamic(open, bins);
  });
  const std::array<const char*, 3> names = {"AR1 sigma2~exp", "AR1 phi~logistic",
                                            "WN sigma2~linear"};
  for (std::size_t t = 0; t < names.size(); ++t) {
    double covered = 0.0;
    double rejected = 0.0;
    for (const DynamicFit& fit : fits) {
      const TrendEstimate& trend = fit.trends[t];
      covered += trend.lower <= 0.0 && 0.0 <= trend.upper ? kShare : 0.0;
      rejected += trend.test.p_value <= 0.05 ? kShare : 0.0;
    }
    std::printf("%-17s slope covered %.1f %%, trend found %.1f %%\n", names[t], 100.0 * covered,
                100.0 * rejected);
    EXPECT_NEAR(covered, 0.95, kAllowance) << names[t];
    EXPECT_NEAR(rejected, 0.05, kAllowance) << names[t];
  }
}

}  // namespace
}  // namespace imunoise
