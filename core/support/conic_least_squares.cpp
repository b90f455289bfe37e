#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

constexpr int kMostRounds = 20'000;
constexpr double kClose = 1e-11;

// A matrix of the cone in coordinates in which the Euclidean length is Frobenius' norm and the
// least-squares problem is well scaled: entry (i, j) times scale_i scale_j, and √2 off the
// diagonal.
class ScaledCones {
 public:
  ScaledCones(const MatrixRef& gram, const std::vector<Eigen::Index>& sizes) : sizes_(sizes) {
    factor_.resize(gram.rows());
    Eigen::Index begin = 0;
    for (const Eigen::Index n : sizes) {
      Eigen::VectorXd scale(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::Index at = begin + packed_index(n, i, i);
        scale(i) = gram(at, at) > 0.0 ? std::pow(gram(at, at), 0.25) : 1.0;
      }
      for (Eigen::Index i = 0; i < n; ++i) {
        for (Eigen::Index j = i; j < n; ++j) {
          factor_(begin + packed_index(n, i, j)) =
              scale(i) * scale(j) * (i == j ? 1.0 : std::numbers::sqrt2);
        }
      }
      begin += packed_size(n);
    }
  }

  /// Scaled coordinates are factor() times the packed entries.
  const Eigen::VectorXd& factor() const { return factor_; }

  /// Nearest point of the cones; `inside` tells whether the point was there already.
  Eigen::VectorXd project(const Eigen::VectorXd& x, bool& inside) const {
    Eigen::VectorXd out = x;
    inside = true;
    Eigen::Index begin = 0;
    for (const Eigen::Index n : sizes_) {
      if (n == 1) {
        inside = inside && x(begin) >= 0.0;
        out(begin) = std::max(x(begin), 0.0);
      } else {
        project_matrix(n, begin, out, inside);
      }
      begin += packed_size(n);
    }
    return out;
  }

 private:
  static double weight(Eigen::Index i, Eigen::Index j) {
    return i == j ? 1.0 : std::numbers::sqrt2;
  }

  static void project_matrix(Eigen::Index n, Eigen::Index begin, Eigen::VectorXd& x, bool& inside) {
    Eigen::MatrixXd full(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        full(i, j) = x(begin + packed_index(n, i, j)) / weight(i, j);
      }
    }
    const SymmetricEigen eigen = symmetric_eigen(full);
    if (eigen.values(0) >= 0.0) return;
    inside = false;
    full = eigen.vectors * eigen.values.cwiseMax(0.0).asDiagonal() * eigen.vectors.transpose();
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = i; j < n; ++j) {
        x(begin + packed_index(n, i, j)) = full(i, j) * weight(i, j);
      }
    }
  }

  std::vector<Eigen::Index> sizes_;
  Eigen::VectorXd factor_;
};

// Numbers only: by their active set, with the columns scaled.
Eigen::VectorXd numbers(const MatrixRef& gram, const VectorRef& moment) {
  const Eigen::VectorXd shrink =
      gram.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 1.0; });
  return shrink.cwiseProduct(nonnegative_least_squares(
      shrink.asDiagonal() * gram * shrink.asDiagonal(), shrink.cwiseProduct(moment)));
}

// Where the numbers lie among the coordinates, and the entries of matrices.
struct Split {
  explicit Split(const std::vector<Eigen::Index>& sizes) {
    Eigen::Index at = 0;
    for (const Eigen::Index size : sizes) {
      for (Eigen::Index i = 0; i < packed_size(size); ++i)
        (size == 1 ? numbers : entries).push_back(at++);
    }
  }
  std::vector<Eigen::Index> numbers;
  std::vector<Eigen::Index> entries;
};

// As if matrices could be anything: their entries are eliminated, the numbers solved for.
Eigen::VectorXd with_free_matrices(const MatrixRef& gram, const VectorRef& moment,
                                   const Split& split) {
  const auto& [inside, free] = split;
  const Eigen::MatrixXd inverse = positive_inverse(gram(free, free)).matrix;
  const Eigen::MatrixXd across = gram(free, inside);
  Eigen::VectorXd out(gram.rows());
  out(inside) = numbers(gram(inside, inside) - across.transpose() * inverse * across,
                        moment(inside) - across.transpose() * inverse * moment(free));
  out(free) = inverse * (moment(free) - across * out(inside));
  return out;
}

// Whether the slope that is left at a point vanishes, or leads out of numbers that are zero.
bool least(const MatrixRef& gram, const VectorRef& moment, const Split& split,
           const Eigen::VectorXd& at) {
  Eigen::VectorXd left = moment - gram * at;
  for (const Eigen::Index i : split.numbers)
    if (at(i) == 0.0) left(i) = std::max(left(i), 0.0);
  return left.norm() <= 1e-9 * moment.norm();
}

}  // namespace

Eigen::VectorXd conic_least_squares(const MatrixRef& gram, const VectorRef& moment,
                                    const std::vector<Eigen::Index>& sizes) {
  const bool plain = std::all_of(sizes.begin(), sizes.end(), [](auto size) { return size == 1; });
  if (plain && gram.rows() <= kMostColumns) return numbers(gram, moment);
  const ScaledCones cones(gram, sizes);
  const Eigen::VectorXd shrink = cones.factor().cwiseInverse();
  const Eigen::MatrixXd g = shrink.asDiagonal() * gram * shrink.asDiagonal();
  const Eigen::VectorXd c = shrink.asDiagonal() * moment;
  const Eigen::Index n = g.rows();

  Eigen::VectorXd x = solve_symmetric(g, c);
  bool inside = false;
  Eigen::VectorXd z = cones.project(x, inside);
  const bool solved = x.allFinite() && (g * x - c).norm() <= 1e-9 * c.norm();
  if (solved && inside) return shrink.asDiagonal() * x;
  if (!x.allFinite()) z.setZero();
  const Split split(sizes);
  if (!split.numbers.empty() && split.numbers.size() <= std::size_t{kMostColumns}) {
    const Eigen::VectorXd trial = with_free_matrices(g, c, split);
    cones.project(trial, inside);
    if (inside && least(g, c, split, trial)) return shrink.asDiagonal() * trial;
  }

  // The penalty of least iterations for a quadratic lies between the extreme eigenvalues of G.
  const SymmetricEigen eigen = symmetric_eigen(g);
  const double largest = eigen.values(n - 1);
  const double rho = std::sqrt(largest * std::max(eigen.values(0), 1e-6 * largest));
  const Eigen::VectorXd damped = (eigen.values.array() + rho).inverse();
  Eigen::VectorXd u = Eigen::VectorXd::Zero(n);
  for (int round = 0; round < kMostRounds; ++round) {
    x = eigen.vectors * (damped.asDiagonal() * (eigen.vectors.transpose() * (c + rho * (z - u))));
    const Eigen::VectorXd before = z;
    z = cones.project(x + u, inside);
    u += x - z;
    const double size = std::max(z.cwiseAbs().maxCoeff(), 1e-300);
    const double moved =
        std::max((x - z).cwiseAbs().maxCoeff(), (z - before).cwiseAbs().maxCoeff());
    if (moved <= kClose * size) break;
  }
  return shrink.asDiagonal() * z;
}

}  // namespace imunoise
