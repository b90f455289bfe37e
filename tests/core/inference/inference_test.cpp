// Test of fit, intervals and observability: what can be seen quickly. The trials look closer.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "core/inference/intervals.h"
#include "core/inference/parameter_covariance.h"
#include "core/support/distributions.h"
#include "core/support/parallel.h"
#include "tests/core/inference/simulated_sets.h"

namespace imunoise {
namespace {

using testing::freed;
using testing::model_of;
using testing::simulated_set;
using testing::theory;

constexpr std::uint64_t kSeed = 8'800;

TEST(Goodness, AcceptsTheRightModelAndRejectsAWrongOne) {
  const auto moments = simulated_set(model_of("AR1(sigma2=0.05, phi=0.97) + WN(sigma2=1)"),
                                     {16'384, 9'000}, 1, kSeed);
  for (const Weighting weighting : {Weighting::kDiagonal, Weighting::kFull}) {
    EXPECT_GT(infer(mugmwm(model_of("AR1 + WN"), moments, weighting), moments).goodness.p_value,
              1e-3);
    EXPECT_LT(infer(mugmwm(model_of("WN"), moments, weighting), moments).goodness.p_value, 1e-9);
    EXPECT_LT(infer(mugmwm(model_of("WN + RW"), moments, weighting), moments).goodness.p_value,
              1e-9);
  }
}

TEST(Goodness, JudgesTheModelNotTheWeights) {
  const auto moments =
      simulated_set(model_of("WN(sigma2=1) + RW(gamma2=1e-3)"), {4096, 4096, 4096}, 1, kSeed);
  const Model open = model_of("WN + RW");
  const Fit diagonal = infer(mugmwm(open, moments, Weighting::kDiagonal), moments);
  const Fit full = infer(mugmwm(open, moments, Weighting::kFull), moments);
  EXPECT_NE(diagonal.estimate.model, full.estimate.model);
  EXPECT_NEAR(diagonal.goodness.statistic, full.goodness.statistic, 1e-6 * full.goodness.statistic);
}

// Scales within an octave differ by so little that it is not normal.
TEST(Goodness, HasItsSizeAtFourScalesAnOctave) {
  constexpr std::size_t kSets = 1000;
  constexpr std::size_t kSamples = 2048;
  const Model truth = model_of("WN(sigma2=1) + RW(gamma2=1e-3)");
  const WaveletVariance expected = theory(truth, kSamples, 4);
  const std::vector<WaveletVariance> one{expected};
  const MomentCovariances covariances = moment_covariances(truth, one);
  const NormalScores scores(truth, expected, covariances[0]);
  std::vector<double> p_values(kSets);
  for_each_index(kSets, [&](std::size_t set) {
    const auto measured = simulated_set(truth, {kSamples}, 4, kSeed + set);
    const Eigen::VectorXd z = scores.residual(measured[0].variance, expected.variance);
    p_values[set] = chi_square_test(z.squaredNorm(), z.size()).p_value;
  });
  const auto rejected =
      std::count_if(p_values.begin(), p_values.end(), [](double p) { return p < 0.05; });
  EXPECT_NEAR(static_cast<double>(rejected) / kSets, 0.05,
              testing::binomial_allowance(0.05, kSets));
}

TEST(Goodness, DoesNotDependOnTheUnit) {
  std::vector<WaveletVariance> moments =
      simulated_set(model_of("WN(sigma2=1) + RW(gamma2=1e-3)"), {4096}, 1, kSeed);
  const Model open = model_of("WN + RW");
  const Fit before = infer(mugmwm(open, moments, Weighting::kFull), moments);
  constexpr double kFactor = 1e-12;
  moments[0].variance *= kFactor;
  moments[0].lower *= kFactor;
  moments[0].upper *= kFactor;
  const Fit after = infer(mugmwm(open, moments, Weighting::kFull), moments);
  EXPECT_NEAR(after.goodness.statistic, before.goodness.statistic,
              1e-6 * before.goodness.statistic);
  for (std::size_t t = 0; t < 2; ++t) {
    EXPECT_NEAR(after.parameters[t][0].upper / (kFactor * before.parameters[t][0].upper), 1.0,
                1e-6);
    EXPECT_NEAR(after.parameters[t][0].lower / (kFactor * before.parameters[t][0].lower), 1.0,
                1e-6);
  }
}

// One scale of few degrees of freedom, nothing free: the p-value is that of the chi-square law on
// either side, although the law is skew. (The size over whole models is in the trials.)
TEST(Goodness, KnowsThatFewDegreesOfFreedomAreSkew) {
  const Model model = model_of("WN(sigma2=1)");
  for (const std::int64_t m : {16, 64, 120}) {
    std::vector<WaveletVariance> moments = {theory(model, 2048)};
    moments[0].scales = Scales({m});
    moments[0].variance = variance(model, moments[0].scales.half_widths());
    set_chi_square_interval(moments[0]);
    const double expected = moments[0].variance(0);
    const double edof = 2.0 * expected * expected / moment_covariances(model, moments)[0](0, 0);
    ASSERT_GT(edof, 5.0);
    for (const double tail : {0.005, 0.025, 0.3, 0.7, 0.975, 0.995}) {
      moments[0].variance(0) = expected * chi_square_quantile(tail, edof) / edof;
      const double p = infer(mugmwm(model, moments, Weighting::kFull), moments).goodness.p_value;
      EXPECT_NEAR(p / (2.0 * std::min(tail, 1.0 - tail)), 1.0, 0.05)
          << "edof " << edof << ", tail " << tail;
    }
  }
}

// The lower bound of a correlation lies below zero.
TEST(ParameterSets, AParameterAtABoundIsNotInside) {
  Ar2 process{1.0, 0.5, 0.3};
  const std::vector<ParameterInfo> about = parameters(Process(process));
  const auto inside = [&](double rho) {
    process.rho1 = rho;
    return parameter_sets(Model{{Term(process)}}).interior.size();
  };
  ASSERT_LT(about[1].lower, 0.0);
  EXPECT_EQ(inside(0.5), 3U);
  EXPECT_EQ(inside(about[1].lower), 2U);
  EXPECT_EQ(inside(about[1].upper), 2U);
  EXPECT_EQ(inside(-0.99), 3U);
}

// A random walk at the edge of what is seen: its interval covers the truth, not only its estimate.
TEST(Intervals, UpperBoundsCover) {
  constexpr std::size_t kSets = 200;
  const Model truth = model_of("WN(sigma2=1) + RW(gamma2=1e-5)");
  std::vector<int> covered(kSets);
  std::vector<int> bound(kSets);
  for_each_index(kSets, [&](std::size_t i) {
    const auto moments = simulated_set(truth, {2048}, 1, kSeed + i);
    const ParameterEstimate walk =
        infer(mugmwm(freed(truth), moments, Weighting::kFull), moments).parameters[1][0];
    bound[i] = walk.observability == Observability::kUpperBound ? 1 : 0;
    covered[i] = walk.lower <= 1e-5 && 1e-5 <= walk.upper ? 1 : 0;
  });
  double share = 0.0;
  double bounds = 0.0;
  for (std::size_t i = 0; i < kSets; ++i) {
    share += covered[i] / static_cast<double>(kSets);
    bounds += bound[i] / static_cast<double>(kSets);
  }
  std::printf("covered %.1f %%, of which %.0f %% are upper bounds\n", 100.0 * share,
              100.0 * bounds);
  EXPECT_GT(bounds, 0.3);
  EXPECT_GE(share, 0.95 - testing::binomial_allowance(0.95, kSets));
}

// A walk too small to be seen in most sets: where it is seen, its estimate is too large, and its
// interval reaches down to the truth all the same.
TEST(Intervals, CoverWhatIsBarelySeen) {
  constexpr std::size_t kSets = 800;
  constexpr double kTruth = 1e-5;
  const Model truth = model_of("WN(sigma2=1) + RW(gamma2=1e-5)");
  std::vector<int> seen(kSets);
  std::vector<int> covered(kSets);
  for_each_index(kSets, [&](std::size_t i) {
    const auto moments = simulated_set(truth, {2048}, 1, kSeed + i);
    const ParameterEstimate walk =
        infer(mugmwm(freed(truth), moments, Weighting::kFull), moments).parameters[1][0];
    seen[i] = walk.observability == Observability::kObserved ? 1 : 0;
    covered[i] = seen[i] != 0 && walk.lower <= kTruth && kTruth <= walk.upper ? 1 : 0;
  });
  const auto of_prepared = static_cast<double>(std::accumulate(seen.begin(), seen.end(), 0));
  const double share = std::accumulate(covered.begin(), covered.end(), 0) / of_prepared;
  std::printf("seen in %.0f of %zu, covered in %.0f %% of these\n", of_prepared, kSets,
              100.0 * share);
  ASSERT_GT(of_prepared, 10.0);
  EXPECT_GE(share, 0.95 - testing::binomial_allowance(0.95, of_prepared));
}

// A Markov process without memory is white noise: one by that name must not take its place.
TEST(WhiteNoise, IsNotTakenByAMarkovProcess) {
  const Model truth = model_of("WN(sigma2=1)");
  for (std::uint64_t seed = kSeed; seed < kSeed + 12; ++seed) {
    for (const char* const model : {"2*AR1 + WN + RW", "GM + WN"}) {
      const auto moments = simulated_set(truth, {16'384, 16'384}, 1, seed);
      const Model open = parse_model(model, Hertz{1.0}).value();
      const Model found = mugmwm(open, moments, Weighting::kFull).model;
      const auto white = std::find_if(found.terms.begin(), found.terms.end(), [](const Term& one) {
        return std::holds_alternative<WhiteNoise>(one.process);
      });
      EXPECT_GT(std::get<WhiteNoise>(white->process).sigma2, 0.5) << model << ", seed " << seed;
    }
  }
}

// The time of a process without power was its start, as if it were known exactly.
TEST(Intervals, OfATimeThatNothingShowsAreWide) {
  const Term term{Process(Ar1{0.0, 0.97})};
  const std::vector<ParameterEstimate> estimates = {
      {0.0, 1e-9, 0.0, 2e-9, Observability::kUpperBound},
      {0.97, INFINITY, -1.0 + 1e-6, 1.0 - 1e-9, Observability::kIndistinguishable}};
  constexpr Hertz kHundred{100.0};
  for (const DerivedQuantity& one : derived(term.process, kHundred)) {
    if (one.coefficient != Coefficient::kCorrelationTime) continue;
    const DerivedEstimate found =
        derived_interval(term, estimates, Eigen::MatrixXd::Zero(2, 2), one, kHundred, 1.96);
    EXPECT_EQ(found.lower, 0.0);
    EXPECT_GT(found.upper, 1e6);
    return;
  }
  FAIL() << "an AR1 has a correlation time";
}

TEST(Intervals, SayWhatTheDataSay) {
  const auto moments =
      simulated_set(model_of("WN(sigma2=1) + RW(gamma2=1e-3)"), {16'384}, 1, kSeed);
  const Fit seen = infer(mugmwm(model_of("WN + RW"), moments, Weighting::kFull), moments);
  EXPECT_EQ(seen.parameters[0][0].observability, Observability::kObserved);
  EXPECT_EQ(record_longer(seen, moments, 1, 0), 1.0);
  const Fit given =
      infer(mugmwm(model_of("WN(sigma2=1) + RW"), moments, Weighting::kFull), moments);
  EXPECT_EQ(given.parameters[0][0].observability, Observability::kGiven);
  EXPECT_EQ(given.parameters[0][0].lower, 1.0);
  EXPECT_LT(given.goodness.degrees_of_freedom, 20);
  EXPECT_EQ(given.goodness.degrees_of_freedom, seen.goodness.degrees_of_freedom + 1);
  const Fit twice = infer(mugmwm(model_of("WN + WN + RW"), moments, Weighting::kFull), moments);
  EXPECT_FALSE(twice.parameters[0][0].observability == Observability::kObserved &&
               twice.parameters[1][0].observability == Observability::kObserved);
}

}  // namespace
}  // namespace imunoise
