#pragma once

// Every dense decomposition of the house. Eigen's are slow to compile, so they live behind this
// door.

#include <Eigen/Core>
#include <vector>

namespace imunoise {

using MatrixRef = Eigen::Ref<const Eigen::MatrixXd>;
using VectorRef = Eigen::Ref<const Eigen::VectorXd>;

/// A whitening of n moments with covariance V (n × n): matrix is r × n with matrixᵀ·matrix = V⁻¹.
struct Whitening {
  Eigen::MatrixXd matrix;
  double condition = 1.0;  ///< Condition number of the correlation matrix of V.
};

/// Whitens by the eigenvectors of the correlation matrix, so that badly scaled moments do no harm.
/// Directions whose eigenvalue is below 1e-13 of the largest carry only rounding and are dropped (r
/// < n).
Whitening whiten(const MatrixRef& covariance);

/// R with R·Rᵀ = S, for a symmetric positive semidefinite S (n × n); negative eigenvalues, which
/// are rounding, count as zero.
Eigen::MatrixXd square_root(const MatrixRef& symmetric);

/// Eigenvalues of a symmetric matrix, ascending, and its orthonormal eigenvectors, one a column.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen symmetric_eigen(const MatrixRef& symmetric);

/// The solution of Sx = b for a symmetric positive semidefinite S; not finite, or no solution,
/// where S is singular.
Eigen::VectorXd solve_symmetric(const MatrixRef& symmetric, const VectorRef& right);

/// A symmetric positive semidefinite matrix inverted on the space where it is not zero.
struct PseudoInverse {
  Eigen::MatrixXd matrix;  ///< p × p
  Eigen::Index rank = 0;
  /// p: share of each unit vector that lies in the null space; 0 when it can be told apart, 1 when
  /// not.
  Eigen::VectorXd null_share;
};

/// Inverts after scaling to a unit diagonal; eigenvalues below `tolerance` (relative) count as
/// zero. Parts of the matrix that nothing joins are inverted one by one.
PseudoInverse pseudo_inverse(const MatrixRef& symmetric, double tolerance = 1e-11);

/// Inverse of a symmetric positive definite matrix. Where it is not positive definite, the
/// logarithm of its determinant is infinite and the inverse zero.
struct PositiveInverse {
  Eigen::MatrixXd matrix;
  double log_determinant;
};
PositiveInverse positive_inverse(const MatrixRef& symmetric);

/// Columns that nonnegative_least_squares() takes.
inline constexpr int kMostColumns = 64;

/// Non-negative least squares in normal form: the minimiser of βᵀGβ - 2cᵀβ over β ≥ 0, with G = AᵀA
/// (p × p, p ≤ kMostColumns, unit diagonal advised) and c = Aᵀb. Columns that depend linearly on
/// those in use stay at zero. Active set of Lawson & Hanson (1974), chapter 23; deterministic.
Eigen::VectorXd nonnegative_least_squares(const MatrixRef& gram, const VectorRef& moment);

/// The same over a product of cones: β holds the upper triangles of symmetric matrices of the given
/// sizes, row by row (packed_index), each of which must be positive semidefinite; size 1 is a
/// number ≥ 0. Up to kMostColumns numbers without a matrix are solved as above, scaled inside. Else
/// exact where no matrix is singular, and otherwise by alternating directions (Boyd et al. 2011,
/// §5.2) to about 1e-9 of the largest entry. Deterministic.
Eigen::VectorXd conic_least_squares(const MatrixRef& gram, const VectorRef& moment,
                                    const std::vector<Eigen::Index>& sizes);

/// Where entry (row, column) of a symmetric n × n matrix is in its packed upper triangle.
constexpr Eigen::Index packed_index(Eigen::Index n, Eigen::Index row, Eigen::Index column) {
  const Eigen::Index low = row < column ? row : column;
  const Eigen::Index high = row < column ? column : row;
  return low * n - low * (low - 1) / 2 + high - low;
}
/// Number of entries of a packed upper triangle.
constexpr Eigen::Index packed_size(Eigen::Index n) { return n * (n + 1) / 2; }

}  // namespace imunoise
