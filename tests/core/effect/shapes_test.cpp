// Closed forms of transforms against the transform of the samples.

#include "core/effect/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/spectrum/cosine_transform.h"

namespace imunoise {
namespace {

void expect_its_transform(const Shape& shape, Eigen::Index n) {
  const Eigen::MatrixXd cosines = shape.cosines(n);
  ASSERT_EQ(cosines.rows(), n - 1);
  for (Eigen::Index i = 0; i < cosines.cols(); ++i) {
    Eigen::VectorXd samples = Eigen::VectorXd::Zero(n);
    shape.add(Eigen::VectorXd::Unit(cosines.cols(), i), samples);
    const Eigen::VectorXd expected = cosine_transform(samples);
    // Rounding of the transform: some ε times the size of the whole.
    EXPECT_LT((cosines.col(i) - expected).norm(), 1e-11 * (samples.norm() + 1.0))
        << "column " << i << " of " << n;
  }
}

TEST(Shapes, ClosedFormsAreTheTransforms) {
  for (const Eigen::Index n : {2, 7, 96, 1000, 4095}) {
    expect_its_transform(ramp(50.0), n);
    for (const double tau : {0.3, 20.0, 5000.0}) expect_its_transform(warm_up(tau, 7), n);
    for (const Eigen::Index at : {Eigen::Index{1}, n / 3, n - 1, n, n + 5})
      expect_its_transform(step(at), n);
    for (const double frequency : {1e-4, 0.0123, 0.125, 0.24999})
      expect_its_transform(waves(frequency, 2), n);
    expect_its_transform(half_waves(n, 3, 0), n);
    expect_its_transform(half_waves(n + 40, 3, 7), n);
    expect_its_transform(half_waves(n - 20, 3, 7), n);
  }
}

TEST(Shapes, AreAddedWithTheirCoefficientsToWhatIsThere) {
  constexpr Eigen::Index kSamples = 1300;  // longer than the stretches that waves are made of
  Eigen::VectorXd to = Eigen::VectorXd::Constant(kSamples, 7.0);
  waves(0.0123, 2).add(Eigen::Vector4d(1.0, -2.0, 0.5, 3.0), to);
  step(400).add(Eigen::VectorXd::Constant(1, 11.0), to);
  for (Eigen::Index t = 0; t < kSamples; ++t) {
    const double angle = 2.0 * 3.14159265358979324 * 0.0123 * static_cast<double>(t);
    EXPECT_NEAR(to(t),
                7.0 + std::cos(angle) - 2.0 * std::sin(angle) + 0.5 * std::cos(2.0 * angle) +
                    3.0 * std::sin(2.0 * angle) + (t < 400 ? 0.0 : 11.0),
                1e-11)
        << t;
  }
}

TEST(Shapes, AWaveAtTheFrequencyOfACoefficient) {
  for (const double k : {1.0, 2.0, 37.0, 500.0}) expect_its_transform(waves(k / 2000.0, 1), 1000);
  expect_its_transform(waves(0.5, 1), 1000);
}

TEST(Shapes, AWaveNextToTheFrequencyOfACoefficientKeepsItsDigits) {
  expect_its_transform(waves((37.0 + 1e-7) / 2000.0, 1), 1000);
}

}  // namespace
}  // namespace imunoise
