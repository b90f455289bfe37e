// The laws every noise process obeys, over the whole list and several parameter values each.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/process/process.h"
#include "core/process/sampler.h"
#include "core/wavelet/moment_covariance.h"
#include "core/wavelet/wavelet_variance.h"
#include "tests/core/process/process_examples.h"
#include "tests/support/figures_alone.h"

namespace imunoise {
namespace {

std::string print(const Process& process) {
  std::string out(info(process).name);
  for (const double v : values(process)) out += " " + std::to_string(v);
  return out;
}

const Eigen::ArrayXd kWidths = (Eigen::ArrayXd(9) << 1, 2, 3, 4, 7, 16, 33, 100, 257).finished();

bool deterministic(const Process& process) { return std::holds_alternative<RateRamp>(process); }

TEST(ProcessLaws, TheListIsComplete) {
  for (const Process& known : known_processes()) {
    const auto all = process_examples();
    EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                            [&](const Process& p) { return p.index() == known.index(); }))
        << info(known).name << " has no example: every law below skips it";
  }
}

TEST(ProcessLaws, JacobianIsTheDerivative) {
  for (const Process& process : process_examples()) {
    const Eigen::ArrayXXd slope = jacobian(process, kWidths);
    const std::vector<double> at = values(process);
    ASSERT_EQ(slope.cols(), static_cast<Eigen::Index>(at.size()));
    for (std::size_t k = 0; k < at.size(); ++k) {
      // Richardson: fourth-order central differences.
      const double step =
          1e-4 * std::min(1.0, std::abs(at[k]) + 1e-3) * (1.0 - 0.9 * (std::abs(at[k]) > 0.98));
      const auto moved = [&](double by) {
        std::vector<double> v = at;
        v[k] += by;
        Process other = process;
        set_values(other, v);
        return variance(other, kWidths);
      };
      const Eigen::ArrayXd numeric =
          (8.0 * (moved(step) - moved(-step)) - (moved(2 * step) - moved(-2 * step))) /
          (12.0 * step);
      for (Eigen::Index i = 0; i < kWidths.size(); ++i) {
        const double scale =
            std::abs(numeric(i)) + 1e-6 * variance(process, kWidths)(i) / std::abs(at[k] + 1e-3);
        EXPECT_NEAR(slope(i, static_cast<Eigen::Index>(k)), numeric(i), 2e-6 * scale)
            << print(process) << ", parameter " << k << ", m = " << kWidths(i);
      }
    }
  }
}

// ν(m) = ∫ |H|² S df, |H(f)|² = sin⁴(πfm) / (m² sin²(πf)).
TEST(ProcessLaws, VarianceIsTheSpectrumSeenThroughTheWavelet) {
  FIGURES_ALONE();
  for (const Process& process : process_examples()) {
    if (deterministic(process)) continue;
    for (const double m : {1.0, 3.0, 16.0}) {
      const int steps = 400'000;
      double sum = 0.0;
      for (int i = 0; i < steps; ++i) {  // midpoint rule: spectral accuracy on a full period
        const double f = 0.5 * (i + 0.5) / steps;
        const double s = std::sin(std::numbers::pi * f);
        const double top = std::pow(std::sin(std::numbers::pi * f * m), 4);
        sum += top / (m * m * s * s) * spectrum(process, f);
      }
      const double integral = sum / steps;  // 2 · (0.5 / steps)
      const double expected = variance(process, Eigen::ArrayXd::Constant(1, m))(0);
      EXPECT_NEAR(integral / expected, 1.0, 1e-6) << print(process) << ", m = " << m;
    }
  }
}

TEST(ProcessLaws, ManyFrequenciesAreEachOfThem) {
  const Frequencies all((Eigen::ArrayXd(7) << 1e-9, 3e-5, 0.01, 0.1, 0.25, 0.4999, 0.5).finished());
  for (const Process& process : process_examples()) {
    const Eigen::ArrayXd found = spectrum(process, all);
    for (Eigen::Index i = 0; i < all.size(); ++i) {
      const double one = spectrum(process, all(i));
      EXPECT_NEAR(found(i), one, 1e-15 * one) << print(process) << ", f = " << all(i);
    }
  }
}

// ν(m) = [6Γ(0) - 8Γ(m) + 2Γ(2m)]/4m² ties the two descriptions a process gives of itself; here
// through the covariance of moments of the shortest signal, where V = 2ν² exactly (one
// coefficient).
TEST(ProcessLaws, SumCovarianceAgreesWithTheVariance) {
  for (const Process& process : process_examples()) {
    for (const std::int64_t m : {1, 2, 5, 16, 100}) {
      const Eigen::MatrixXd v =
          moment_covariance(sum_covariance(process), Scales({m}), static_cast<std::size_t>(2 * m));
      const double nu = variance(process, Eigen::ArrayXd::Constant(1, static_cast<double>(m)))(0);
      const double expected = deterministic(process) ? 0.0 : 2.0 * nu * nu;
      EXPECT_NEAR(v(0, 0), expected, 1e-9 * (nu * nu)) << print(process) << ", m = " << m;
    }
  }
}

// Simulated from the stationary start, the measured variance scatters about ν with exactly the
// covariance V: the mean over 64 runs lies within 5 standard errors at every scale.
TEST(ProcessLaws, SimulationFollowsTheVariance) {
  constexpr int kRuns = 64;
  constexpr std::size_t kSamples = 4096;
  const Scales scales({1, 2, 5, 16, 60});
  for (const Process& process : process_examples()) {
    Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(scales.size()));
    for (std::uint32_t run = 0; run < kRuns; ++run) {
      RandomStream rng(20261121, {run});
      std::vector<double> x(kSamples, 0.0);
      add_samples(process, rng, x);
      sum += wavelet_variance(Signal{std::span<const double>(x), Hertz{1}}, scales).variance;
    }
    const Eigen::ArrayXd expected = variance(process, scales.half_widths());
    const Eigen::MatrixXd v = moment_covariance(sum_covariance(process), scales, kSamples);
    for (Eigen::Index i = 0; i < expected.size(); ++i) {
      const double standard_error = std::sqrt(v(i, i) / kRuns);
      EXPECT_NEAR(sum(i) / kRuns, expected(i), 5.0 * standard_error + 1e-9 * expected(i))
          << print(process) << ", m = " << scales[static_cast<std::size_t>(i)] << ", seed 20261121";
    }
  }
}

// The same stream, sample by sample and all at once. Flicker noise is drawn for a known length, by
// another way; model_sampler_test.cpp looks at its recursion.
TEST(ProcessLaws, SampleBySampleIsTheSameNoise) {
  for (const Process& process : process_examples()) {
    if (std::holds_alternative<Flicker>(process)) continue;
    RandomStream rng(42);
    std::vector<double> at_once(500, 0.0);
    add_samples(process, rng, at_once);
    Sampler sampler(process, RandomStream(42));
    for (std::size_t t = 0; t < at_once.size(); ++t) {
      ASSERT_NEAR(sampler.next(), at_once[t], 1e-12 * (1.0 + std::abs(at_once[t])))
          << print(process) << ", t = " << t;
    }
  }
}

}  // namespace
}  // namespace imunoise
