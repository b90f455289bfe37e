// Moments and likelihood are two estimates of the same parameters from the same data. Where the
// model is right the likelihood's is efficient, so that their difference has the variance
// V_moments - V_likelihood (Hausman 1978), which is at most V_moments.

#include <gtest/gtest.h>

#include <cmath>

#include "core/inference/efficient_fit.h"

namespace imunoise {
namespace {

constexpr Hertz kAgreeRate{100.0};
constexpr std::size_t kAgreeSamples = 16'384;
constexpr std::uint32_t kAgreeRuns = 16;
constexpr std::uint64_t kAgreeSeed = 20261123;

struct BothFits {
  Fit moments;
  Fit likelihood;
};

BothFits both_fits(const Model& truth, const Model& written, std::uint32_t run) {
  const std::vector<double> samples = simulate(truth, kAgreeSamples, kAgreeSeed, run);
  const Signal signal{std::span<const double>(samples), kAgreeRate};
  const WaveletVariance measured = wavelet_variance(signal, Scales::for_samples(kAgreeSamples));
  const BandedPower powers = banded_power(signal);
  const std::span<const WaveletVariance> one(&measured, 1);
  const Fit moments = infer(mugmwm(written, one, Weighting::kFull), one);
  return {moments, make_efficient(moments, one, std::span(&powers, 1))};
}

class EstimatorsAgree : public ::testing::TestWithParam<const char*> {};

// Of 16 runs of each number: none differs by more than 4.5 standard errors (chance: 1e-4 a number),
// and their mean by no more than 4.5 of its own.
TEST_P(EstimatorsAgree, WithinTheirErrors) {
  const Model truth = parse_model(GetParam(), kAgreeRate).value();
  Model written = truth;
  for (Term& term : written.terms) term.given.assign(term.given.size(), false);
  std::vector<double> sum(parameter_count(truth), 0.0);
  for (std::uint32_t run = 0; run < kAgreeRuns; ++run) {
    const BothFits fits = both_fits(truth, written, run);
    std::size_t number = 0;
    for (std::size_t t = 0; t < truth.terms.size(); ++t) {
      for (std::size_t p = 0; p < truth.terms[t].given.size(); ++p, ++number) {
        const ParameterEstimate& one = fits.moments.parameters[t][p];
        const ParameterEstimate& other = fits.likelihood.parameters[t][p];
        const double z = (one.value - other.value) / one.standard_error;
        EXPECT_LT(std::abs(z), 4.5)
            << "term " << t << ", parameter " << p << ", run " << run << ", seed " << kAgreeSeed;
        sum[number] += z;
      }
    }
  }
  for (const double one : sum) EXPECT_LT(std::abs(one) / std::sqrt(double{kAgreeRuns}), 4.5);
}

INSTANTIATE_TEST_SUITE_P(Models, EstimatorsAgree,
                         ::testing::Values("WN(sigma2=1) + RW(gamma2=1e-4)",
                                           "AR1(sigma2=0.1, phi=0.97) + WN(sigma2=1)",
                                           "WN(sigma2=1) + FN(b2=0.05)",
                                           "RES(sigma2=0.05, r=0.97, omega=0.8) + WN(sigma2=1)"));

// A resonance is where they differ most. The differences are as large as the two errors say:
// Σ D²/(V_moments - V_likelihood) is χ² with 16 degrees of freedom, 2.5 to 48 in all but one of
// 10,000 cases.
TEST(EstimatorsAgree, DifferAsMuchAsTheirErrorsSay) {
  const Model truth =
      parse_model("RES(sigma2=0.05, r=0.97, omega=0.8) + WN(sigma2=1)", kAgreeRate).value();
  Model written = truth;
  for (Term& term : written.terms) term.given.assign(term.given.size(), false);
  double squares = 0.0;
  for (std::uint32_t run = 0; run < kAgreeRuns; ++run) {
    const BothFits fits = both_fits(truth, written, run);
    const ParameterEstimate& one = fits.moments.parameters[0][2];  // omega
    const ParameterEstimate& other = fits.likelihood.parameters[0][2];
    const double variance =
        one.standard_error * one.standard_error - other.standard_error * other.standard_error;
    ASSERT_GT(variance, 0.0) << run;
    squares += (one.value - other.value) * (one.value - other.value) / variance;
  }
  EXPECT_GT(squares, 2.5) << "seed " << kAgreeSeed;
  EXPECT_LT(squares, 48.0) << "seed " << kAgreeSeed;
}

}  // namespace
}  // namespace imunoise
