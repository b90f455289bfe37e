#include "core/support/linear_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace imunoise {
namespace {

using SmallMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostColumns, kMostColumns>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostColumns, 1>;

// Eigenvectors and values of D S D, D = diag(S)^-1/2 (zero rows keep a zero scale).
struct ScaledEigen {
  Eigen::VectorXd scale;
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

ScaledEigen scaled_eigen(const MatrixRef& symmetric) {
  ScaledEigen out;
  out.scale =
      symmetric.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; });
  const Eigen::MatrixXd scaled = out.scale.asDiagonal() * symmetric * out.scale.asDiagonal();
  SymmetricEigen eigen = symmetric_eigen(scaled);
  out.values = std::move(eigen.values);
  out.vectors = std::move(eigen.vectors);
  return out;
}

// Numbers of rows that nothing joins to others: coefficients of a replicate each, say.
std::vector<std::vector<Eigen::Index>> independent_parts(const MatrixRef& symmetric) {
  const Eigen::Index n = symmetric.rows();
  std::vector<std::vector<Eigen::Index>> out;
  std::vector<bool> seen(static_cast<std::size_t>(n), false);
  for (Eigen::Index first = 0; first < n; ++first) {
    if (seen[static_cast<std::size_t>(first)]) continue;
    seen[static_cast<std::size_t>(first)] = true;
    std::vector<Eigen::Index> part{first};
    for (std::size_t at = 0; at < part.size(); ++at) {
      for (Eigen::Index other = first + 1; other < n; ++other) {
        if (seen[static_cast<std::size_t>(other)] || symmetric(other, part[at]) == 0.0) continue;
        seen[static_cast<std::size_t>(other)] = true;
        part.push_back(other);
      }
    }
    std::sort(part.begin(), part.end());
    out.push_back(std::move(part));
  }
  return out;
}

// Of a matrix so well conditioned that no eigenvalue could count as zero: a twentieth of the time
// that its eigenvectors take.
std::optional<PseudoInverse> inverse_by_cholesky(const Eigen::MatrixXd& symmetric,
                                                 double tolerance) {
  const Eigen::Index n = symmetric.rows();
  if (!(symmetric.diagonal().array() > 0.0).all()) return std::nullopt;
  const Eigen::VectorXd scale = symmetric.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * symmetric * scale.asDiagonal());
  constexpr double kFar = 1e4;  // rcond() is an estimate
  if (factor.info() != Eigen::Success || !(factor.rcond() > kFar * tolerance)) return std::nullopt;
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(n, n));
  return PseudoInverse{scale.asDiagonal() * inverse * scale.asDiagonal(), n,
                       Eigen::VectorXd::Zero(n)};
}

PseudoInverse inverse_of_part(const Eigen::MatrixXd& symmetric, double tolerance) {
  const Eigen::Index n = symmetric.rows();
  constexpr Eigen::Index kLarge = 32;
  if (n >= kLarge) {
    if (auto quick = inverse_by_cholesky(symmetric, tolerance)) return std::move(*quick);
  }
  PseudoInverse out;
  const ScaledEigen eigen = scaled_eigen(symmetric);
  const double cut = tolerance * eigen.values(n - 1);
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(n);
  out.null_share = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (eigen.values(i) > cut) {
      inverse(i) = 1.0 / eigen.values(i);
      ++out.rank;
    } else {
      out.null_share += eigen.vectors.col(i).cwiseAbs2();
    }
  }
  out.matrix = eigen.scale.asDiagonal() * eigen.vectors * inverse.asDiagonal() *
               eigen.vectors.transpose() * eigen.scale.asDiagonal();
  return out;
}

// Columns in use during the active-set iteration, and the least-squares solution on them.
class PassiveSet {
 public:
  PassiveSet(const MatrixRef& gram, const VectorRef& moment) : gram_(gram), moment_(moment) {}

  int size() const { return size_; }
  Eigen::Index operator[](int i) const { return index_[static_cast<std::size_t>(i)]; }
  void add(Eigen::Index j) { index_[static_cast<std::size_t>(size_++)] = j; }
  void drop(int i) {
    for (int k = i + 1; k < size_; ++k) {
      index_[static_cast<std::size_t>(k - 1)] = index_[static_cast<std::size_t>(k)];
    }
    --size_;
  }

  // False when the columns in use are linearly dependent to working precision.
  bool solve(SmallVector& solution) const {
    SmallMatrix g(size_, size_);
    SmallVector c(size_);
    for (int a = 0; a < size_; ++a) {
      c(a) = moment_((*this)[a]);
      for (int b = 0; b < size_; ++b) g(a, b) = gram_((*this)[a], (*this)[b]);
    }
    const Eigen::LLT<SmallMatrix> factor(g);
    if (factor.info() != Eigen::Success) return false;
    for (int a = 0; a < size_; ++a) {
      const double pivot = factor.matrixLLT()(a, a);
      if (pivot * pivot < 1e-13 * g(a, a)) return false;
    }
    solution = factor.solve(c);
    return true;
  }

 private:
  const MatrixRef& gram_;
  const VectorRef& moment_;
  std::array<Eigen::Index, kMostColumns> index_{};
  int size_ = 0;
};

}  // namespace

SymmetricEigen symmetric_eigen(const MatrixRef& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd solve_symmetric(const MatrixRef& symmetric, const VectorRef& right) {
  return Eigen::LDLT<Eigen::MatrixXd>(symmetric).solve(right);
}

PositiveInverse positive_inverse(const MatrixRef& symmetric) {
  const Eigen::Index n = symmetric.rows();
  const Eigen::LLT<Eigen::MatrixXd> factor(symmetric);
  const Eigen::VectorXd diagonal = factor.matrixLLT().diagonal();
  if (factor.info() != Eigen::Success || !(diagonal.array() > 0.0).all()) {
    return {Eigen::MatrixXd::Zero(n, n), std::numeric_limits<double>::infinity()};
  }
  return {factor.solve(Eigen::MatrixXd::Identity(n, n)), 2.0 * diagonal.array().log().sum()};
}

Whitening whiten(const MatrixRef& covariance) {
  const ScaledEigen eigen = scaled_eigen(covariance);
  const Eigen::Index n = covariance.rows();
  const double largest = eigen.values(n - 1);
  Eigen::Index first = 0;
  while (first < n - 1 && eigen.values(first) < 1e-13 * largest) ++first;
  Whitening out;
  out.condition = largest / eigen.values(first);
  out.matrix = eigen.values.tail(n - first).cwiseSqrt().cwiseInverse().asDiagonal() *
               eigen.vectors.rightCols(n - first).transpose() * eigen.scale.asDiagonal();
  return out;
}

Eigen::MatrixXd square_root(const MatrixRef& symmetric) {
  const SymmetricEigen eigen = symmetric_eigen(symmetric);
  return eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

PseudoInverse pseudo_inverse(const MatrixRef& symmetric, double tolerance) {
  const Eigen::Index n = symmetric.rows();
  PseudoInverse out{Eigen::MatrixXd::Zero(n, n), 0, Eigen::VectorXd::Zero(n)};
  for (const std::vector<Eigen::Index>& one : independent_parts(symmetric)) {
    const PseudoInverse part = inverse_of_part(symmetric(one, one), tolerance);
    out.matrix(one, one) = part.matrix;
    out.rank += part.rank;
    out.null_share(one) = part.null_share;
  }
  return out;
}

Eigen::VectorXd nonnegative_least_squares(const MatrixRef& gram, const VectorRef& moment) {
  const Eigen::Index columns = gram.rows();
  assert(columns <= kMostColumns);
  Eigen::VectorXd beta = Eigen::VectorXd::Zero(columns);
  if (columns == 0) return beta;
  PassiveSet passive(gram, moment);
  enum class Column : char { kOpen, kInUse, kDependent };
  std::array<Column, kMostColumns> state{};
  const auto state_of = [&](Eigen::Index j) -> Column& {
    return state[static_cast<std::size_t>(j)];
  };
  const double tolerance = 1e-14 * moment.cwiseAbs().maxCoeff();
  SmallVector solution;

  for (Eigen::Index guard = 0; guard < 8 * columns; ++guard) {
    const Eigen::VectorXd slope = moment - gram * beta;
    Eigen::Index best = -1;
    for (Eigen::Index j = 0; j < columns; ++j) {
      const bool better = best < 0 || slope(j) > slope(best);
      if (state_of(j) == Column::kOpen && slope(j) > tolerance && better) best = j;
    }
    if (best < 0) break;
    passive.add(best);
    state_of(best) = Column::kInUse;
    // A column that depends on those in use, or would enter with the wrong sign by rounding, stays
    // out.
    if (!passive.solve(solution) || solution(passive.size() - 1) <= 0.0) {
      passive.drop(passive.size() - 1);
      state_of(best) = Column::kDependent;
      continue;
    }
    while (solution.minCoeff() <= 0.0) {  // walk towards the solution until a column reaches zero
      double step = 1.0;
      int first = 0;
      for (int a = 0; a < passive.size(); ++a) {
        const double now = beta(passive[a]);
        if (solution(a) > 0.0 || now / (now - solution(a)) >= step) continue;
        step = now / (now - solution(a));
        first = a;
      }
      for (int a = 0; a < passive.size(); ++a) {
        beta(passive[a]) += step * (solution(a) - beta(passive[a]));
      }
      beta(passive[first]) = 0.0;
      state_of(passive[first]) = Column::kOpen;
      passive.drop(first);
      std::replace(state.begin(), state.end(), Column::kDependent, Column::kOpen);
      if (!passive.solve(solution)) return beta;
    }
    for (int a = 0; a < passive.size(); ++a) beta(passive[a]) = solution(a);
  }
  return beta;
}

}  // namespace imunoise
