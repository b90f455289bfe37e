// Power of the tests of near-stationarity against replicates that differ, on simulated samples.
//
// Theory. One power of the model differs between K replicates: its logarithm is N(0, s²) about a
// mean. Near the truth, the whitened moments of replicate k are normal with unit variance, and a
// deviation d_k of that logarithm moves them by a·d_k; with full weights the sandwich (Godambe)
// information is Fisher's, I = AᵀV⁻¹A, and I_ee = aᵀV⁻¹a is its diagonal entry. The heterogeneity
// test has all p parameters free in each replicate, so that it keeps what A can explain, less the
// mean over replicates:
//   X | d ~ non-central χ² with (K-1)p degrees of freedom, non-centrality I_ee Σ (d_k - mean d)²,
//   Σ (d_k - mean d)² ~ s² χ² with K-1 degrees of freedom.
// The misfit test has taken out what parameters of each replicate's own explain: it stays at 5 %.

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "core/inference/moment_draws.h"
#include "core/inference/near_stationarity.h"
#include "core/support/distributions.h"
#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"
#include "tests/core/inference/power_curve.h"
#include "tests/core/inference/simulated_sets.h"

namespace imunoise {
namespace {

using testing::PowerCurve;
using testing::PowerPoint;

constexpr std::uint64_t kSeed = 20261122;
constexpr std::size_t kSets = 250;
constexpr std::size_t kNullDraws = 2000;
constexpr std::size_t kReplicates = 6;
constexpr std::size_t kSamples = 8192;  // of a replicate
constexpr double kLevel = 0.05;
// Where the theory, which is linear in the deviations, must hold; beyond, the curve is shown only.
constexpr double kSmall = 0.2;

struct Case {
  const char* truth;
  std::size_t moves;  // the term whose power differs
  const char* words;
  std::vector<double> spreads;
};

Model truth_of(const Case& c) { return testing::model_of(c.truth); }

// aᵀV⁻¹a on the scales that the tests use, those of at least 5 degrees of freedom 2ν²/V_jj. The
// variance is linear in a power: its derivative by the logarithm is the term itself.
double information(const Case& c) {
  const Model truth = truth_of(c);
  const std::vector<WaveletVariance> like = {testing::theory(truth, kSamples)};
  const Eigen::MatrixXd v = moment_covariances(truth, like)[0];
  const Eigen::ArrayXd slope = variance(truth.terms[c.moves].process, like[0].scales.half_widths());
  std::vector<Eigen::Index> used;
  for (Eigen::Index j = 0; j < v.rows(); ++j) {
    if (2.0 * like[0].variance(j) * like[0].variance(j) / v(j, j) >= 5.0) used.push_back(j);
  }
  return (whiten(v(used, used)).matrix * slope(used).matrix()).squaredNorm();
}

// The power of the heterogeneity test: the mean over equally likely values of Σ (d_k - mean d)².
double predicted_power(const Case& c, double spread) {
  constexpr int kQuantiles = 400;
  const auto degrees = static_cast<double>((kReplicates - 1) * parameter_count(truth_of(c)));
  const double critical = chi_square_quantile(1.0 - kLevel, degrees);
  const double weight = spread * spread * information(c);
  double sum = 0.0;
  for (int i = 0; i < kQuantiles; ++i) {
    const double squares =
        chi_square_quantile((i + 0.5) / kQuantiles, static_cast<double>(kReplicates - 1));
    const boost::math::non_central_chi_squared law(degrees, weight * squares);
    sum += cdf(complement(law, critical)) / kQuantiles;
  }
  return sum;
}

double published_statistic(const Model& open, const std::vector<WaveletVariance>& moments) {
  return mugmwm(open, moments, Weighting::kDiagonal).objective;
}

// The 95 % point of the published statistic where replicates do not differ: what a bootstrap with
// the true model would find.
double published_critical(const Case& c) {
  const Model truth = truth_of(c);
  const std::vector<WaveletVariance> like(kReplicates, testing::theory(truth, kSamples));
  const MomentDraws draws(truth, like, moment_covariances(truth, like));
  std::vector<double> statistic(kNullDraws);
  for_each_index(kNullDraws, [&](std::size_t i) {
    RandomStream stream(kSeed, {static_cast<std::uint32_t>(i)});
    statistic[i] = published_statistic(testing::freed(truth), draws.draw(stream));
  });
  const auto at = statistic.begin() + static_cast<std::ptrdiff_t>((1.0 - kLevel) * kNullDraws);
  std::nth_element(statistic.begin(), at, statistic.end());
  return *at;
}

// Moments of replicates whose power `c.moves` differs by exp(s·z).
std::vector<WaveletVariance> differing_set(const Case& c, double spread, std::uint64_t seed) {
  std::vector<WaveletVariance> out;
  RandomStream deviations(seed, {0xD1FFU});
  for (std::size_t k = 0; k < kReplicates; ++k) {
    Model own = truth_of(c);
    Process& process = own.terms[c.moves].process;
    std::vector<double> parameters = values(process);
    parameters[0] *= std::exp(spread * deviations.normal());
    set_values(process, parameters);
    const std::uint64_t replicate_seed = seed * kReplicates + k;
    out.push_back(testing::simulated_set(own, {kSamples}, 1, replicate_seed)[0]);
  }
  return out;
}

PowerPoint measure(const Case& c, double spread, double published_limit, std::uint64_t seed) {
  struct Rejected {
    bool misfit, heterogeneity, published;
  };
  const Model open = testing::freed(truth_of(c));
  std::vector<Rejected> sets(kSets);
  for_each_index(kSets, [&](std::size_t i) {
    const NearStationarity found = near_stationarity(open, differing_set(c, spread, seed + i));
    sets[i] = {found.misfit.p_value() < kLevel, found.heterogeneity.p_value() < kLevel,
               found.published_statistic > published_limit};
  });
  const auto share = [&](bool Rejected::*which) {
    const auto count =
        std::count_if(sets.begin(), sets.end(), [&](const Rejected& r) { return r.*which; });
    return static_cast<double>(count) / static_cast<double>(kSets);
  };
  return {spread, share(&Rejected::misfit), share(&Rejected::heterogeneity),
          share(&Rejected::published), predicted_power(c, spread)};
}

// `seed`: the next one that is free.
PowerCurve measure(const Case& c, std::uint64_t& seed) {
  PowerCurve out{
      print(testing::freed(truth_of(c))), c.words, 1.0 / std::sqrt(information(c)), kSets, {}};
  const double limit = published_critical(c);
  std::printf("%s: %s differs (error of one replicate %.1f %%)\n", c.truth, c.words,
              100.0 * out.error);
  std::printf("  spread  misfit  heterogeneity  theory  published\n");
  for (const double spread : c.spreads) {
    const PowerPoint p = measure(c, spread, limit, seed);
    seed += kSets;
    std::printf("  %4.0f %%  %4.1f %%         %5.1f %% %5.1f %%    %5.1f %%\n", 100.0 * spread,
                100.0 * p.misfit, 100.0 * p.heterogeneity, 100.0 * p.predicted,
                100.0 * p.published);
    out.points.push_back(p);
  }
  return out;
}

// A later share may be lower by chance only: 3.3 standard errors of the difference.
void expect_rising(const PowerCurve& curve, double PowerPoint::*share) {
  for (std::size_t i = 1; i < curve.points.size(); ++i) {
    const double before = curve.points[i - 1].*share;
    const double after = curve.points[i].*share;
    const double allowance = std::hypot(testing::binomial_allowance(before, kSets),
                                        testing::binomial_allowance(after, kSets));
    EXPECT_GE(after, before - allowance) << curve.points[i].spread;
  }
}

void expect_theory(const PowerCurve& curve) {
  // The critical value of the published statistic has an error of its own.
  EXPECT_NEAR(curve.points[0].published, kLevel,
              std::hypot(testing::binomial_allowance(kLevel, kSets),
                         testing::binomial_allowance(kLevel, kNullDraws)));
  for (const PowerPoint& p : curve.points) {
    if (p.spread > kSmall) continue;
    EXPECT_NEAR(p.misfit, kLevel, testing::binomial_allowance(kLevel, kSets)) << p.spread;
    EXPECT_NEAR(p.heterogeneity, p.predicted, testing::binomial_allowance(p.predicted, kSets))
        << p.spread;
  }
  expect_rising(curve, &PowerPoint::heterogeneity);
  expect_rising(curve, &PowerPoint::published);
}

TEST(PowerOfNearStationarity, FollowsTheory) {
  std::printf("%zu sets of %zu replicates of %zu samples a spread, seeds from %llu\n", kSets,
              kReplicates, kSamples, static_cast<unsigned long long>(kSeed));
  const char* const markov = "AR1(sigma2=0.01, phi=0.98) + WN(sigma2=1)";
  std::vector<PowerCurve> curves;
  std::uint64_t seed = kSeed;
  for (const Case& c :
       {Case{markov, 1, "σ² of WN", {0.0, 0.01, 0.02, 0.05, 0.1, 0.2}},
        Case{markov, 0, "σ² of AR1", {0.0, 0.02, 0.05, 0.1, 0.2, 0.5}},
        Case{"WN(sigma2=1) + RW(gamma2=1e-3)", 1, "γ² of RW", {0.0, 0.02, 0.05, 0.1, 0.2, 0.5}}}) {
    SCOPED_TRACE(c.words);
    curves.push_back(measure(c, seed));
    expect_theory(curves.back());
  }
  const char* const figure = "near-stationarity-power.svg";
  std::ofstream(figure) << testing::power_figure(curves);
  std::printf("drawn in %s\n", figure);
}

}  // namespace
}  // namespace imunoise
