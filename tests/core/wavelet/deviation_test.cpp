#include "core/wavelet/deviation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "core/support/random.h"
#include "core/wavelet/moment_covariance.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise::testing {
namespace {

// The 1,000 points of NIST SP 1065, section 12.4: a linear congruential generator.
std::vector<double> nist_points() {
  std::vector<double> out;
  std::int64_t n = 1234567890;
  for (int i = 0; i < 1000; ++i) {
    out.push_back(static_cast<double>(n) / 2147483647.0);
    n = 16807 * n % 2147483647;
  }
  return out;
}

// Table 31 there; Stable32 and allantools print the same.
TEST(Deviation, NistSp1065Points) {
  const std::vector<double> points = nist_points();
  double mean = 0.0;
  for (const double x : points) mean += x / 1000.0;
  EXPECT_NEAR(mean, 4.897745e-1, 1e-7);
  const Signal signal(std::span<const double>{points}, Hertz{1.0});
  const std::vector<std::size_t> factors = {1, 10, 100};
  const Eigen::ArrayXd allan = deviation_variance(DeviationKind::kAllan, signal, factors).sqrt();
  EXPECT_NEAR(allan(0), 2.922319e-1, 5e-8);
  EXPECT_NEAR(allan(1), 9.159953e-2, 5e-9);
  EXPECT_NEAR(allan(2), 3.241343e-2, 5e-9);
  const Eigen::ArrayXd hadamard =
      deviation_variance(DeviationKind::kHadamard, signal, factors).sqrt();
  EXPECT_NEAR(hadamard(0), 2.943883e-1, 5e-8);
  EXPECT_NEAR(hadamard(1), 9.581083e-2, 5e-9);
  EXPECT_NEAR(hadamard(2), 3.237638e-2, 5e-9);
}

TEST(Deviation, AllanIsTwiceTheWaveletVariance) {
  const std::vector<double> points = nist_points();
  const Signal signal(std::span<const double>{points}, Hertz{1.0});
  const WaveletVariance wavelet = wavelet_variance(signal, Scales({1, 7, 64}));
  const Eigen::ArrayXd allan = deviation_variance(DeviationKind::kAllan, signal, {1, 7, 64});
  for (Eigen::Index i = 0; i < 3; ++i)
    EXPECT_NEAR(allan(i), 2.0 * wavelet.variance(i), 1e-12 * allan(i));
}

TEST(Deviation, HadamardIsBlindToARamp) {
  std::vector<double> points = nist_points();
  const Eigen::ArrayXd before =
      deviation_variance(DeviationKind::kHadamard, Signal(std::span(points), Hertz{1.0}), {1, 40});
  for (std::size_t i = 0; i < points.size(); ++i) points[i] += 1e-2 * static_cast<double>(i);
  const Eigen::ArrayXd after =
      deviation_variance(DeviationKind::kHadamard, Signal(std::span(points), Hertz{1.0}), {1, 40});
  for (Eigen::Index i = 0; i < 2; ++i) EXPECT_NEAR(before(i), after(i), 1e-9 * before(i));
}

TEST(Deviation, CustomaryFactorsEndWithTheData) {
  EXPECT_EQ(customary_factors(DeviationKind::kAllan, 100),
            (std::vector<std::size_t>{1, 2, 4, 10, 20, 40}));
  EXPECT_EQ(customary_factors(DeviationKind::kHadamard, 100),
            (std::vector<std::size_t>{1, 2, 4, 10, 20}));
  EXPECT_TRUE(customary_factors(DeviationKind::kHadamard, 2).empty());
}

// 2ν²/Var of the exact covariance of wavelet variances.
TEST(Deviation, DegreesOfFreedomOfAllanAreExact) {
  constexpr std::size_t kLength = 4096;
  const Scales scales({1, 4, 64, 512, 1500});
  const std::pair<NoiseType, SumCovariance> laws[] = {
      {NoiseType::kWhite, {.linear = -0.5}},
      {NoiseType::kRandomWalk, {.linear = -1.0 / 12.0, .cubic = 1.0 / 12.0}}};
  for (const auto& [law, sums] : laws) {
    const Eigen::MatrixXd v = moment_covariance(sums, scales, kLength);
    for (std::size_t i = 0; i < scales.size(); ++i) {
      const auto m = static_cast<double>(scales[i]);
      const double nu = law == NoiseType::kWhite ? 0.5 / m : (2.0 * m * m + 1.0) / (12.0 * m);
      const auto at = static_cast<Eigen::Index>(i);
      const double exact = 2.0 * nu * nu / v(at, at);
      EXPECT_NEAR(deviation_degrees(DeviationKind::kAllan, law, kLength,
                                    static_cast<std::size_t>(scales[i])),
                  std::max(exact, 1.0), 0.015 * exact)
          << scales[i];
    }
  }
}

// Against 400 simulated estimates: the variance of a sample variance is known to √(2/400) = 7
// %, 4.5 standard deviations are 32 %.
TEST(Deviation, DegreesOfFreedomOfHadamardBySimulation) {
  constexpr int kRuns = 400;
  constexpr std::size_t kLength = 600;
  const std::vector<std::size_t> factors = {4, 40};
  for (const NoiseType law : {NoiseType::kWhite, NoiseType::kRandomWalk}) {
    RandomStream rng(5);
    Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(2);
    Eigen::ArrayXd squares = Eigen::ArrayXd::Zero(2);
    for (int run = 0; run < kRuns; ++run) {
      std::vector<double> x(kLength);
      double level = 0.0;
      for (double& one : x) {
        level += rng.normal();
        one = law == NoiseType::kWhite ? rng.normal() : level;
      }
      const Eigen::ArrayXd v =
          deviation_variance(DeviationKind::kHadamard, Signal(std::span(x), Hertz{1.0}), factors);
      sum += v;
      squares += v.square();
    }
    const Eigen::ArrayXd mean = sum / kRuns;
    const Eigen::ArrayXd variance = squares / kRuns - mean.square();
    for (Eigen::Index i = 0; i < 2; ++i) {
      const double found = 2.0 * mean(i) * mean(i) / variance(i);
      const double exact = deviation_degrees(DeviationKind::kHadamard, law, kLength,
                                             factors[static_cast<std::size_t>(i)]);
      EXPECT_NEAR(found / exact, 1.0, 0.32) << "m = " << factors[static_cast<std::size_t>(i)];
    }
  }
}

}  // namespace
}  // namespace imunoise::testing
