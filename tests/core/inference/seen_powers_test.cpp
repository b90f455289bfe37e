// Powers that are seen: hardly ever where there are none, and with an interval that holds the truth
// where there are.

#include <gtest/gtest.h>

#include <cstdio>

#include "core/inference/efficient_fit.h"
#include "core/spectrum/banded_power.h"
#include "core/support/parallel.h"
#include "tests/core/inference/simulated_sets.h"

namespace imunoise {
namespace {

constexpr std::uint64_t kSeenSeed = 31'000;
constexpr std::size_t kSeenSamples = 4096;

struct SeenShares {
  double seen = 0.0;
  double covered = 0.0;  // of those seen
};

struct SeenPower {
  const char* truth;
  const char* model;
  double power;        // of the second term
  double least = 0.0;  // of the sets in which the likelihood sees it
};

// By moments, and by the likelihood.
std::pair<SeenShares, SeenShares> seen_shares(const SeenPower& of, std::size_t sets) {
  const Model truth = testing::model_of(of.truth);
  std::vector<Fit> fits(2 * sets);
  for_each_index(sets, [&](std::size_t i) {
    const std::vector<double> x = simulate(truth, kSeenSamples, kSeenSeed + i, 0);
    const Signal signal(std::span<const double>(x), testing::kTrialRate);
    const std::vector<WaveletVariance> moments = {
        wavelet_variance(signal, Scales::for_samples(kSeenSamples, 1))};
    const std::vector<BandedPower> powers = {banded_power(signal)};
    fits[2 * i] = infer(mugmwm(testing::model_of(of.model), moments, Weighting::kFull), moments);
    fits[2 * i + 1] = make_efficient(fits[2 * i], moments, powers);
  });
  const auto share = [&](std::size_t which) {
    SeenShares out;
    for (std::size_t i = 0; i < sets; ++i) {
      const ParameterEstimate& one = fits[2 * i + which].parameters[1][0];
      if (one.observability != Observability::kObserved) continue;
      out.seen += 1.0;
      out.covered += one.lower <= of.power && of.power <= one.upper ? 1.0 : 0.0;
    }
    if (out.seen > 0.0) out.covered /= out.seen;
    out.seen /= static_cast<double>(sets);
    return out;
  };
  return {share(0), share(1)};
}

// White noise and a Markov process without memory are the same: their error is large, and an upper
// end was 260 times the variance of all noise.
TEST(Powers, AreBelowAllNoiseThereIs) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto moments =
        testing::simulated_set(testing::model_of("WN(sigma2=1)"), {4000, 4000, 4000}, 1, seed);
    const Fit fit =
        infer(mugmwm(testing::model_of("WN + AR1 + RW"), moments, Weighting::kFull), moments, 0.95);
    for (const std::vector<ParameterEstimate>& term : fit.parameters)
      EXPECT_LT(term[0].upper, 4.5) << "seed " << seed;
  }
}

// Slow noise has few degrees of freedom at the shortest scale, too: what is known of its power is
// no more than its standard error says.
TEST(Powers, OfSlowNoiseKeepTheirIntervals) {
  for (const char* const floor : {"1e-5", "1e-4", "1e-3", "1e-2"}) {
    const Model truth = testing::model_of(
        std::string("LOWPASS(4, sigma2=1, omega=0.03) + WN(sigma2=") + floor + ")");
    Model model = truth;
    model.terms[0].given[0] = false;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const auto moments = testing::simulated_set(truth, {4096}, 1, seed);
      const ParameterEstimate power =
          infer(mugmwm(model, moments, Weighting::kFull), moments, 0.95).parameters[0][0];
      EXPECT_GT(power.upper, power.value + 1.95 * power.standard_error)
          << truth.terms.size() << " " << floor << ", seed " << seed;
    }
  }
}

class SeenPowers : public ::testing::TestWithParam<SeenPower> {};

// Chance makes a power seen in 2.5 %, by moments in up to 5 %: they scatter to one side. Where it
// is seen, the interval is one of 95 %.
TEST_P(SeenPowers, AreThere) {
  constexpr std::size_t kSets = 600;
  const SeenPower& of = GetParam();
  const auto [moments, likelihood] = seen_shares(of, kSets);
  std::printf(
      "%s, seeds from %llu: by moments seen %.1f %%, covered %.1f %%; by likelihood %.1f, %.1f\n",
      of.truth, static_cast<unsigned long long>(kSeenSeed), 100.0 * moments.seen,
      100.0 * moments.covered, 100.0 * likelihood.seen, 100.0 * likelihood.covered);
  if (of.power == 0.0) {
    EXPECT_LT(moments.seen, 0.05 + testing::binomial_allowance(0.05, kSets));
    EXPECT_LT(likelihood.seen, 0.025 + testing::binomial_allowance(0.025, kSets));
    return;
  }
  for (const SeenShares& one : {moments, likelihood})
    EXPECT_GE(one.covered, 0.95 - testing::binomial_allowance(0.95, one.seen * kSets));
  EXPECT_GT(likelihood.seen, of.least);
}

INSTANTIATE_TEST_SUITE_P(
    Powers, SeenPowers,
    ::testing::Values(SeenPower{"WN(sigma2=1)", "WN + RW", 0.0},
                      SeenPower{"WN(sigma2=1)", "WN + QN", 0.0},
                      SeenPower{"WN(sigma2=1)", "WN + FN", 0.0},
                      SeenPower{"WN(sigma2=1) + RW(gamma2=1e-6)", "WN + RW", 1e-6},
                      SeenPower{"WN(sigma2=1) + RW(gamma2=1e-5)", "WN + RW", 1e-5, 0.6},
                      SeenPower{"WN(sigma2=1) + RW(gamma2=1e-4)", "WN + RW", 1e-4, 0.98}));

}  // namespace
}  // namespace imunoise
