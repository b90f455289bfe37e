#include "core/support/linear_algebra.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace imunoise {
namespace {

Eigen::MatrixXd random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(engine); });
}

// The optimum of a convex problem is told by its Karush-Kuhn-Tucker conditions, whatever the solver
// did.
void expect_optimal(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment, const char* what) {
  const Eigen::VectorXd beta = nonnegative_least_squares(gram, moment);
  const Eigen::VectorXd slope = moment - gram * beta;
  const double scale = moment.cwiseAbs().maxCoeff();
  for (Eigen::Index j = 0; j < beta.size(); ++j) {
    EXPECT_GE(beta(j), 0.0) << what;
    EXPECT_LE(slope(j), 1e-9 * scale) << what << ": column " << j << " would still help";
    EXPECT_NEAR(slope(j) * beta(j), 0.0, 1e-9 * scale * (1.0 + beta(j))) << what;
  }
}

TEST(NonnegativeLeastSquares, MeetsTheOptimalityConditions) {
  for (unsigned seed = 1; seed <= 500; ++seed) {
    const int columns = 1 + static_cast<int>(seed % 9);
    Eigen::MatrixXd a = random_matrix(20, columns, seed).cwiseAbs();
    a.colwise().normalize();
    const Eigen::VectorXd b = random_matrix(20, 1, seed + 1000);
    expect_optimal(a.transpose() * a, a.transpose() * b, ("seed " + std::to_string(seed)).c_str());
  }
}

TEST(NonnegativeLeastSquares, ToleratesRepeatedColumns) {
  Eigen::MatrixXd a = random_matrix(20, 4, 7).cwiseAbs();
  a.col(3) = a.col(1);
  a.colwise().normalize();
  const Eigen::VectorXd b = a * Eigen::Vector4d(1, 2, 0, 3);
  const Eigen::VectorXd beta = nonnegative_least_squares(a.transpose() * a, a.transpose() * b);
  EXPECT_NEAR((a * beta - b).norm(), 0.0, 1e-12);
}

TEST(Whiten, TurnsTheCovarianceIntoTheIdentity) {
  const Eigen::MatrixXd root = random_matrix(6, 6, 3);
  Eigen::MatrixXd covariance = root * root.transpose();
  const Eigen::VectorXd scale = Eigen::VectorXd::LinSpaced(6, -8, 4).array().exp();
  covariance = (scale.asDiagonal() * covariance * scale.asDiagonal()).eval();
  const Whitening w = whiten(covariance);
  ASSERT_EQ(w.matrix.rows(), 6);
  const Eigen::MatrixXd identity = w.matrix * covariance * w.matrix.transpose();
  EXPECT_NEAR((identity - Eigen::MatrixXd::Identity(6, 6)).cwiseAbs().maxCoeff(), 0.0, 1e-9);
}

TEST(PseudoInverse, TellsWhatCannotBeToldApart) {
  Eigen::MatrixXd a = random_matrix(10, 3, 5);
  a.col(2) = 2.0 * a.col(1);
  const PseudoInverse inverse = pseudo_inverse(a.transpose() * a);
  EXPECT_EQ(inverse.rank, 2);
  EXPECT_NEAR(inverse.null_share(0), 0.0, 1e-12);
  EXPECT_NEAR(inverse.null_share(1), 0.5, 1e-9);
  EXPECT_NEAR(inverse.null_share(2), 0.5, 1e-9);
}

// Parts that nothing joins, interleaved: small and singular, large and sound, large and singular.
TEST(PseudoInverse, OfPartsIsThatOfTheWhole) {
  constexpr int kParts = 3;
  const std::array<int, kParts> sizes{3, 40, 40};
  const Eigen::Index n = 120;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n, n);
  for (int p = 0; p < kParts; ++p) {
    const int size = sizes[static_cast<std::size_t>(p)];
    Eigen::MatrixXd a = random_matrix(2 * size, size, static_cast<unsigned>(p) + 11);
    if (p != 1) a.col(size - 1) = 2.0 * a.col(0);
    const auto rows = Eigen::seqN(p, size, kParts);
    whole(rows, rows) = a.transpose() * a;
  }
  const PseudoInverse found = pseudo_inverse(whole);
  EXPECT_EQ(found.rank, 2 + 40 + 39);
  const Eigen::MatrixXd again = whole * found.matrix * whole;
  EXPECT_LT((again - whole).cwiseAbs().maxCoeff(), 1e-9 * whole.cwiseAbs().maxCoeff());
  EXPECT_LT((found.matrix - found.matrix.transpose()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(found.null_share(0), 0.5, 1e-9);   // doubles the third of its part
  EXPECT_NEAR(found.null_share(1), 0.0, 1e-12);  // of the sound part
  EXPECT_NEAR(found.null_share(2), 0.5, 1e-9);
  EXPECT_NEAR(found.null_share(9), 1.0, 1e-12);  // a row of zeros
}

// Where no matrix is singular a number is zero exactly, and the slopes of all else vanish.
TEST(ConicLeastSquares, IsExactWhereOnlyNumbersAreZero) {
  std::mt19937_64 random(20261122);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::MatrixXd a(12, 5);
    for (double& x : a.reshaped()) x = normal(random);
    // At (2, 0.3, 1), (1.5), 0, with a slope that leads out of the last.
    const Eigen::VectorXd wanted{{2.0, 0.3, 1.0, 1.5, 0.0}};
    const Eigen::MatrixXd gram = a.transpose() * a;
    Eigen::VectorXd moment = gram * wanted;
    moment(4) -= 1.0;
    const Eigen::VectorXd found = conic_least_squares(gram, moment, {2, 1, 1});
    EXPECT_EQ(found(4), 0.0);
    EXPECT_LT((found - wanted).norm(), 1e-9);
  }
}

// A random problem over one 3 × 3 matrix and two numbers, at the optimum: the slope in every cone
// is itself in the cone (dual) and orthogonal to the solution.
TEST(ConicLeastSquares, MeetsTheOptimalityConditions) {
  std::mt19937_64 random(20261121);
  std::normal_distribution<double> normal;
  int singular = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Eigen::MatrixXd a(12, 8);
    Eigen::VectorXd b(12);
    for (double& x : a.reshaped()) x = normal(random);
    for (double& x : b) x = normal(random);
    const Eigen::VectorXd beta =
        conic_least_squares(a.transpose() * a, a.transpose() * b, {3, 1, 1});
    const Eigen::VectorXd slope = a.transpose() * (a * beta - b);
    Eigen::Matrix3d solution;
    Eigen::Matrix3d dual;
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index j = 0; j < 3; ++j) {
        solution(i, j) = beta(packed_index(3, i, j));
        dual(i, j) = slope(packed_index(3, i, j)) * (i == j ? 1.0 : 0.5);
      }
    }
    const double size = b.norm();
    EXPECT_GT(symmetric_eigen(solution).values(0), -1e-8 * size);
    EXPECT_GT(symmetric_eigen(dual).values(0), -1e-6 * size);
    EXPECT_NEAR((solution * dual).trace(), 0.0, 1e-6 * size * size);
    for (const Eigen::Index i : {6, 7}) {
      EXPECT_GE(beta(i), 0.0);
      EXPECT_GT(slope(i), -1e-6 * size);
      EXPECT_NEAR(beta(i) * slope(i), 0.0, 1e-6 * size * size);
    }
    singular += symmetric_eigen(solution).values(0) < 1e-9 ? 1 : 0;
  }
  EXPECT_GT(singular, 100) << "the constraint must matter in most trials";
}

}  // namespace
}  // namespace imunoise
