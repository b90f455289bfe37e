// Closed forms of transforms against the transform of the samples.

#include "core/diagnosis/shapes.h"

#include <gtest/gtest.h>

#include "core/spectrum/cosine_transform.h"

namespace imunoise {
namespace {

void expect_its_transform(const Shape& shape, Eigen::Index n) {
  const Eigen::MatrixXd samples = shape.samples(n);
  const Eigen::MatrixXd cosines = shape.cosines(n);
  ASSERT_EQ(cosines.rows(), n - 1);
  ASSERT_EQ(cosines.cols(), samples.cols());
  for (Eigen::Index i = 0; i < samples.cols(); ++i) {
    const Eigen::VectorXd expected = cosine_transform(samples.col(i));
    // Rounding of the transform: some ε times the size of the whole.
    EXPECT_LT((cosines.col(i) - expected).norm(), 1e-11 * (samples.col(i).norm() + 1.0))
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
