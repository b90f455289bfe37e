// The cosine transform against its definition, and what makes it the transform of choice: white
// noise and a random walk together have independent coefficients of known variance.

#include "core/spectrum/cosine_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/spectrum/banded_power.h"
#include "core/spectrum/cross_power.h"
#include "core/spectrum/roots_of_unity.h"

namespace imunoise {
namespace {

// Rows k = 1 … n-1 of the orthonormal DCT-II.
Eigen::MatrixXd dense_transform(Eigen::Index n) {
  Eigen::MatrixXd out(n - 1, n);
  for (Eigen::Index k = 1; k < n; ++k) {
    for (Eigen::Index t = 0; t < n; ++t) {
      out(k - 1, t) = std::sqrt(2.0 / static_cast<double>(n)) *
                      std::cos(std::numbers::pi * static_cast<double>(k) *
                               (static_cast<double>(t) + 0.5) / static_cast<double>(n));
    }
  }
  return out;
}

Eigen::VectorXd some_series(Eigen::Index n) {
  Eigen::VectorXd x(n);
  for (Eigen::Index t = 0; t < n; ++t) {
    const auto at = static_cast<double>(t);
    x(t) = std::sin(0.7 * at * at) + 0.01 * at + 5.0;
  }
  return x;
}

TEST(CosineTransform, IsWhatItsFormulaSays) {
  for (const Eigen::Index n : {2, 7, 12, 65, 1001}) {
    const Eigen::VectorXd x = some_series(n);
    const Eigen::VectorXd direct = dense_transform(n) * x;
    EXPECT_LT((cosine_transform(x) - direct).norm(), 1e-12 * x.norm()) << n;
  }
}

// Long ones are cut in rows and columns.
TEST(CosineTransform, IsWhatItsFormulaSaysOfLongSeries) {
  for (const Eigen::Index n : {16384, 30030, 27027, 15625}) {
    const Eigen::VectorXd x = some_series(n);
    const Eigen::VectorXd all = cosine_transform(x);
    for (const Eigen::Index k : {Eigen::Index{1}, Eigen::Index{2}, n / 3, n / 2, n - 1}) {
      double direct = 0.0;
      for (Eigen::Index t = 0; t < n; ++t)
        direct +=
            x(t) * std::cos(std::numbers::pi * static_cast<double>(k * (2 * t + 1) % (4 * n)) /
                            (2.0 * static_cast<double>(n)));
      direct *= std::sqrt(2.0 / static_cast<double>(n));
      EXPECT_NEAR(all(k - 1), direct, 1e-12 * x.norm()) << n << " " << k;
    }
  }
}

// White coefficients, for which the rough one is meant, of a length with every quick factor.
TEST(CosineTransform, RoughOrNotTheInverseGivesTheSeriesBack) {
  for (const Eigen::Index n : {2, 7, 12, 65, 1001, 30030}) {
    Eigen::VectorXd x = some_series(n);
    x.array() -= x.mean();
    const Eigen::VectorXd cosines = cosine_transform(x);
    const double length = x.norm();
    EXPECT_LT((inverse_cosine_transform(cosines) - x).norm(), 1e-13 * length) << n;
    EXPECT_LT((rough_inverse_cosine_transform(cosines) - x).norm(), 1e-6 * length) << n;
  }
}

TEST(RootsOfUnity, AreExactFarOut) {
  constexpr std::size_t kN = 4'000'000;
  const RootsOfUnity turns(kN);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1023}, std::size_t{1024}, kN / 3, kN}) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / kN;
    EXPECT_LT(std::abs(turns(k) - std::polar(1.0, angle)), 1e-15) << k;
  }
}

TEST(CosineTransform, MakesAWalkIndependent) {
  constexpr Eigen::Index kN = 60;
  Eigen::MatrixXd walk(kN, kN);
  for (Eigen::Index s = 0; s < kN; ++s) {
    for (Eigen::Index t = 0; t < kN; ++t) walk(s, t) = static_cast<double>(std::min(s, t) + 1);
  }
  Eigen::MatrixXd half(kN - 1, kN);  // its columns transformed
  for (Eigen::Index t = 0; t < kN; ++t) half.col(t) = cosine_transform(walk.col(t));
  Eigen::MatrixXd found(kN - 1, kN - 1);
  for (Eigen::Index k = 0; k < kN - 1; ++k)
    found.row(k) = cosine_transform(half.row(k).transpose()).transpose();
  for (Eigen::Index k = 1; k < kN; ++k) {
    const double sine = std::sin(std::numbers::pi * static_cast<double>(k) / (2.0 * kN));
    EXPECT_NEAR(found(k - 1, k - 1), 1.0 / (4.0 * sine * sine), 1e-9) << k;
  }
  found.diagonal().setZero();
  EXPECT_LT(found.cwiseAbs().maxCoeff(), 1e-9);
}

TEST(CosineTransform, QuickLengthsAreCloseAndSmooth) {
  EXPECT_EQ(quick_length(0), 0U);
  EXPECT_EQ(quick_length(17), 16U);
  EXPECT_EQ(quick_length(1400), 1400U);
  EXPECT_EQ(quick_length(1'000'000), 1'000'000U);
  for (std::size_t n = 100; n < 20'000; ++n) {
    const double kept = static_cast<double>(quick_length(n)) / static_cast<double>(n);
    EXPECT_GE(kept, n < 1000 ? 0.96 : 0.98) << n;
    EXPECT_LE(kept, 1.0) << n;
  }
}

TEST(BandedPower, HoldsEveryCoefficientOnce) {
  constexpr Eigen::Index kN = 4000;
  const Eigen::VectorXd x = some_series(kN);
  const BandedPower bands =
      banded_power(Signal(std::span<const double>(x.data(), kN), Hertz{100.0}));
  const Eigen::VectorXd c = cosine_transform(x);
  EXPECT_EQ(bands.count.sum(), kN - 1);
  EXPECT_NEAR((bands.count * bands.power).sum(), c.squaredNorm(), 1e-9 * c.squaredNorm());
  EXPECT_EQ(bands.frequency(0), 1.0 / (2.0 * kN));
  EXPECT_LT(bands.frequency(bands.frequency.size() - 1), 0.5);
  EXPECT_GT(bands.frequency.size(), 700);
  // One more coefficient for every 256 below the band.
  const Eigen::ArrayXd below = 2.0 * kN * bands.frequency.cycles() - 0.5 * bands.count;
  EXPECT_LE((bands.count - 1.0 - below / 256.0).maxCoeff(), 0.01);
}

TEST(BandedPower, ReadsCountsWithTheirScaleAndDropsTheOffset) {
  std::vector<std::int16_t> counts(640);
  std::vector<double> values(640);
  for (std::size_t t = 0; t < counts.size(); ++t) {
    counts[t] = static_cast<std::int16_t>((t * t * 31) % 201);
    values[t] = 0.5 * counts[t];
  }
  const BandedPower a = banded_power(
      Signal(std::span<const std::int16_t>(counts), Hertz{1.0}, Quantity::kUnknown, 0.5, 1e9));
  const BandedPower b = banded_power(Signal(std::span<const double>(values), Hertz{1.0}));
  EXPECT_LT((a.power - b.power).abs().maxCoeff(), 1e-10);
}

TEST(BandedPower, ARampOfSlopeOneIsItsOwnRamp) {
  std::vector<double> x(960);
  for (std::size_t t = 0; t < x.size(); ++t) x[t] = -3.0 * static_cast<double>(t);
  const BandedPower bands = banded_power(Signal(std::span<const double>(x), Hertz{1.0}));
  EXPECT_NEAR(bands.ramp_cross(0) / bands.ramp_power(0), -3.0, 1e-12);
  EXPECT_NEAR(bands.power(0) / bands.ramp_power(0), 9.0, 1e-12);
}

// The transform of a ramp in closed form, against that of its samples.
TEST(BandedPower, KnowsTheTransformOfARamp) {
  for (const Eigen::Index n : {64, 1001, 4096, 30'000}) {
    Eigen::MatrixXd both(n, 2);
    both << some_series(n), Eigen::VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1));
    const CrossPower plain = cross_power(both, Hertz{1.0});
    const std::span<const double> samples(both.col(0).data(), static_cast<std::size_t>(n));
    const BandedPower bands = banded_power(Signal(samples, Hertz{1.0}));
    for (Eigen::Index b = 0; b < bands.power.size(); ++b) {
      const Eigen::MatrixXd& at = plain.power[static_cast<std::size_t>(b)];
      // To the rounding of the largest coefficient: samples leave even ones a little, not zero.
      const double rounding = 1e-13 * std::sqrt(plain.power.front()(1, 1));
      const double ramp = std::sqrt(at(1, 1));
      EXPECT_NEAR(bands.power(b), at(0, 0), 1e-10 * at(0, 0));
      EXPECT_NEAR(bands.ramp_cross(b), at(0, 1), std::sqrt(at(0, 0)) * (1e-9 * ramp + rounding));
      EXPECT_NEAR(std::sqrt(bands.ramp_power(b)), ramp, 1e-9 * ramp + rounding) << n << " " << b;
    }
  }
}

// Sums over all bands stay; of a power law the mean over a band is its value there.
TEST(BandedPower, WiderBandsHoldTheSame) {
  BandedPower fine = bands_of(1'000'000, Hertz{1.0});
  fine.power = fine.frequency.cycles().pow(-2.0);
  const BandedPower wide = in_wider_bands(fine);
  EXPECT_LT(wide.power.size(), fine.power.size() / 3);
  EXPECT_EQ(wide.count.sum(), fine.count.sum());
  EXPECT_NEAR((wide.count * wide.power).sum() / (fine.count * fine.power).sum(), 1.0, 1e-12);
  for (Eigen::Index b = 0; b < 64; ++b) EXPECT_EQ(wide.frequency(b), fine.frequency(b));
  const Eigen::ArrayXd ratio = wide.power * wide.frequency.cycles().square();
  EXPECT_NEAR(ratio.maxCoeff(), 1.0, 2e-4);
  EXPECT_NEAR(ratio.minCoeff(), 1.0, 1e-9);
}

}  // namespace
}  // namespace imunoise
