// AR2 with real, complex and equal roots: against arithmetic of 120 digits, against the processes
// that it contains, and recovered from simulated data.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/array/array_whittle.h"
#include "core/inference/efficient_fit.h"
#include "core/process/process.h"
#include "tests/core/array/simulated_array.h"

namespace imunoise {
namespace {

// The AR2 with roots z₁, z₂.
Ar2 of_roots(std::complex<double> z1, std::complex<double> z2) {
  const double product = (z1 * z2).real();
  return {1.0, (z1 + z2).real() / (1.0 + product), -product};
}

// ν(m) from Yule-Walker's autocovariances, or from both roots, in 120 digits (mpmath 1.3).
TEST(Ar2, WaveletVarianceInHighPrecision) {
  struct Row {
    double rho1, phi2;
    std::array<double, 5> variance;  // at m = 1, 3, 64, 4096, 2^22
  };
  const std::vector<Row> rows = {
      {0.5,
       0.25,
       {0.35555555555555556, 0.24046103395061728, 0.051736111115440379, 0.00086712307400173611,
        8.4770961418851382e-7}},
      {0.999,
       -0.2,
       {0.26054694013673504, 0.75900133100630391, 15.550647843632881, 64.15700876605458,
        0.082764513772061771}},
      {0.8,
       -0.7,
       {0.54466230936819164, 1.9773061825223915, 0.07117108463635657, 0.0010568477633117133,
        1.0312230635591766e-6}},
      {0.9,  // equal roots but for 2e-6 of their square
       -0.39286,
       {0.3111860289035998, 0.98222873966799406, 0.37294958650569214, 0.0062848310524194321,
        6.1446150064242266e-6}},
      {0.9999,
       -0.98,
       {6.3134469854805816, 55.362859425253343, 13724.372013605179, 3054.9878122612847,
        3.0406870127702}},
      {-0.95,
       -0.7,
       {19.607843137254882, 1.6981245383986908, 0.002597831996257337, 1.1568846915208596e-5,
        1.0848273411749585e-8}},
      {1.0 - std::ldexp(1.0, -30),  // memories of 4,000 samples and more
       -1.0 + std::ldexp(1.0, -12),
       {512.06250786877365, 4607.1181284845319, 2082197.5421042142, 5652169883.6669945,
        32807263600.994277}},
      {0.0, 0.0, {0.5, 0.16666666666666667, 0.0078125, 0.0001220703125, 1.1920928955078125e-7}}};
  const Eigen::ArrayXd m = (Eigen::ArrayXd(5) << 1, 3, 64, 4096, 1 << 22).finished();
  for (const Row& row : rows) {
    const Eigen::ArrayXd found = variance(Ar2{1.0, row.rho1, row.phi2}, m);
    for (Eigen::Index i = 0; i < m.size(); ++i) {
      EXPECT_NEAR(found(i) / row.variance[static_cast<std::size_t>(i)], 1.0, 1e-10)
          << row.rho1 << " " << row.phi2 << " " << m(i);
    }
  }
}

TEST(Ar2, ContainsAr1AndTheResonance) {
  const Eigen::ArrayXd m{{1.0, 5.0, 64.0, 1000.0}};
  const Eigen::ArrayXd f = Eigen::ArrayXd::LinSpaced(50, 0.001, 0.5);
  const Resonance ringing{2.0, 0.97, 0.4};
  Ar2 same = of_roots(std::polar(0.97, 0.4), std::polar(0.97, -0.4));
  same.sigma2 = 2.0;
  const std::vector<std::pair<Process, Process>> pairs = {{Ar2{3.0, 0.9, 0.0}, Ar1{3.0, 0.9}},
                                                          {same, ringing}};
  for (const auto& [one, other] : pairs) {
    EXPECT_LT((variance(one, m) / variance(other, m) - 1.0).abs().maxCoeff(), 1e-11);
    EXPECT_LT((spectrum(one, f) / spectrum(other, f) - 1.0).abs().maxCoeff(), 1e-11);
  }
  const auto quantities = same.derived(Hertz{100});
  const auto expected = ringing.derived(Hertz{100});
  ASSERT_EQ(quantities.size(), 3U);
  EXPECT_NEAR(quantities[1].value, expected[0].value, 1e-12 * expected[0].value);
  EXPECT_NEAR(quantities[2].value, expected[1].value, 1e-12);
  EXPECT_NEAR(quantities[0].value, expected[2].value, 1e-11 * expected[2].value);
}

// Roots of one sign are a difference of two AR1, roots of opposite sign a sum of two.
TEST(Ar2, IsASumOfTwoAr1OnlyWhereItsRootsHaveOppositeSigns) {
  const Eigen::ArrayXd m{{1.0, 5.0, 64.0, 1000.0}};
  for (const double other : {0.6, -0.6}) {
    const Ar2 process = of_roots(0.95, other);
    const auto part = [&](double z, double apart) {  // variance of the AR1's innovations
      return z / (apart * (1.0 + process.phi2));
    };
    const double first = part(0.95, 0.95 - other);
    const double second = part(other, other - 0.95);
    EXPECT_GT(first, 0.0);
    EXPECT_EQ(second > 0.0, other < 0.0);
    const Eigen::ArrayXd sum =
        first * variance(Ar1{1.0, 0.95}, m) + second * variance(Ar1{1.0, other}, m);
    EXPECT_LT((sum / variance(process, m) - 1.0).abs().maxCoeff(), 1e-11) << other;
  }
}

// Every estimate within 4.5 standard errors of the truth: chance breaks one of the 2 × 4 × 4
// numbers once in 4,600 seeds.
TEST(Ar2, IsRecoveredBesideWhiteNoise) {
  constexpr std::size_t kSamples = 32'768;
  const Model written = parse_model("AR2 + WN", Hertz{1}).value();
  for (const Ar2 shape : {of_roots(0.99, 0.8), of_roots(0.9, 0.9), of_roots(0.9, -0.5),
                          of_roots(std::polar(0.95, 0.3), std::polar(0.95, -0.3))}) {
    Model truth = written;
    set_values(truth.terms[0].process, std::vector<double>{2.0, shape.rho1, shape.phi2});
    const std::vector<double> samples = simulate(truth, kSamples, 20261123, 0);
    const Signal signal{std::span<const double>(samples), Hertz{1}};
    const WaveletVariance moments = wavelet_variance(signal, Scales::for_samples(kSamples, 2));
    const BandedPower powers = banded_power(signal);
    const Fit by_moments =
        infer(mugmwm(written, std::span(&moments, 1), Weighting::kFull), std::span(&moments, 1));
    const Fit by_likelihood =
        make_efficient(by_moments, std::span(&moments, 1), std::span(&powers, 1));
    for (const Fit* fit : {&by_moments, &by_likelihood}) {
      for (std::size_t t = 0; t < 2; ++t) {
        const std::vector<double> wanted = values(truth.terms[t].process);
        for (std::size_t p = 0; p < wanted.size(); ++p) {
          const ParameterEstimate& found = fit->parameters[t][p];
          EXPECT_EQ(found.observability, Observability::kObserved) << t << " " << p;
          EXPECT_NEAR(found.value, wanted[p], 4.5 * found.standard_error)
              << shape.rho1 << " " << shape.phi2 << ", term " << t << ", parameter " << p;
        }
      }
    }
  }
}

// The published mixed model: an AR2 in all series, an AR1 in each group, white noise of their own.
TEST(Ar2, IsRecoveredAsTheGlobalProcessOfAMixedModel) {
  const Model written = parse_array_model("AR2[all] + AR1[group] + WN", Hertz{1}).value();
  ArrayModel truth = expand(written, {6, {0, 0, 0, 1, 1, 1}});
  const Ar2 global = of_roots(0.97, 0.7);
  const std::vector<std::vector<double>> shapes = {
      {1.0, global.rho1, global.phi2}, {1.0, 0.98}, {1.0, 0.9}};
  const std::vector<double> powers = {0.05, 0.02, 0.1};
  for (std::size_t t = 0; t < truth.latents.size(); ++t) {
    truth.latents[t].set_scalar(t < 3 ? powers[t] : 0.5);
    if (t < 3) set_values(truth.latents[t].term.process, shapes[t]);
  }
  const Eigen::MatrixXd samples = simulate(truth, 1440, 20261123, 0);
  const WaveletCovariance moments = testing::moments_of(samples);
  const CrossPower spectra = testing::powers_of(samples);
  const ArrayFit fit = make_efficient(
      fit_array(written, {6, {0, 0, 0, 1, 1, 1}}, std::span(&moments, 1)), std::span(&spectra, 1));
  EXPECT_EQ(fit.parameters.size(), 13U);
  for (const ArrayParameter& parameter : fit.parameters) {
    const Latent& latent = truth.latents[parameter.latent];
    const double wanted = parameter.parameter == 0
                              ? latent.scalar()
                              : values(latent.term.process)[parameter.parameter];
    EXPECT_NEAR(parameter.estimate.value, wanted, 4.5 * parameter.estimate.standard_error)
        << parameter.latent << " " << parameter.parameter;
  }
}

}  // namespace
}  // namespace imunoise
