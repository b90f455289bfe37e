// Sample by sample is the same noise as all at once.

#include "core/model/model_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/process/flicker_recursion.h"

namespace imunoise {
namespace {

constexpr Hertz kSamplerRate{100};

TEST(ModelSampler, SampleBySampleGivesTheNumbersOfSimulate) {
  const Model model =
      *parse_model("WN(sigma2=2) + AR1(sigma2=1, phi=0.9) + RW(gamma2=0.5)", kSamplerRate);
  const std::vector<double> at_once = simulate(model, 500, 42, 3);
  ModelSampler sampler(model, 42, 3);
  for (std::size_t i = 0; i < at_once.size(); ++i) {
    ASSERT_NEAR(sampler.next(), at_once[i], 1e-12 * (1.0 + std::abs(at_once[i]))) << i;
  }
}

// Γ(k + 1/2) / (√π k!): the trapezoidal rule's error is e^(-π²)√2 · 2 = 1.5e-4 of it.
TEST(FlickerRecursion, IsTheHalfIntegrator) {
  RandomStream rng(1);
  const std::vector<double> h = FlickerRecursion(1.0, rng).impulse_response(100'001);
  EXPECT_NEAR(h[0], 1.0, 1e-12);
  double exact = 1.0;
  for (std::size_t k = 1; k < h.size(); ++k) {
    exact *= (static_cast<double>(k) - 0.5) / static_cast<double>(k);
    ASSERT_NEAR(h[k] / exact, 1.0, 3e-4) << k;
  }
}

// ν(m) = E(difference of two means of m samples)² / 4, in the very first 2m samples; and the first
// sample is as far off as any later one: the spectrum 1 / (2 sin πf), integrated from the end of
// the bank's memory T on, is ln(4T) / π, ln T = 34.5. 1000 runs: five deviations are 22 %.
TEST(FlickerRecursion, HasItsWaveletVarianceFromTheStart) {
  const Model model = *parse_model("FN(b2=1)", kSamplerRate);
  constexpr std::uint32_t kRuns = 1000;
  const std::vector<std::size_t> widths = {1, 16, 256};
  std::vector<double> squares(widths.size());
  double first_square = 0.0;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    ModelSampler sampler(model, 7, run);
    std::vector<double> sums = {0.0};  // of the samples before
    while (sums.size() <= 2 * widths.back()) sums.push_back(sums.back() + sampler.next());
    first_square += sums[1] * sums[1];
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const std::size_t m = widths[i];
      const double difference = (sums[2 * m] - 2.0 * sums[m]) / static_cast<double>(m);
      squares[i] += difference * difference;
    }
  }
  EXPECT_NEAR(first_square / kRuns / ((34.5 + std::log(4.0)) / std::numbers::pi), 1.0, 0.25);
  for (std::size_t i = 0; i < widths.size(); ++i) {
    const Eigen::ArrayXd m = Eigen::ArrayXd::Constant(1, static_cast<double>(widths[i]));
    EXPECT_NEAR(squares[i] / (4.0 * kRuns) / variance(model, m)[0], 1.0, 0.22) << widths[i];
  }
}

}  // namespace
}  // namespace imunoise
