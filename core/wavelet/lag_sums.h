#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/wavelet/scales.h"
#include "core/wavelet/sum_covariance.h"

namespace imunoise {

/// What every covariance of measured wavelet moments is made of. With γ^p_jk(s) the covariance of
/// the coefficients of process p at scales j and k, s samples apart, and c(s) the number of pairs
/// at that lag among T samples,
///   products(j, k)(p, q) = Σ_s c(s) γ^p_jk(s) γ^q_jk(s) / (M_j M_k),
///   plain(j, k)(p)       = Σ_s c(s) γ^p_jk(s) / (M_j M_k).
/// Both are the same for (k, j). The sums run over every integer lag, evaluated with discrete Gauss
/// quadrature between the kinks of γ, to about 1e-9 relative. Precondition: T ≥ 2m. Thread-safe to
/// read.
class LagSums {
 public:
  LagSums(std::span<const SumCovariance> processes, const Scales& scales, std::size_t samples);

  const Eigen::MatrixXd& products(std::size_t j, std::size_t k) const { return at(j, k).products; }
  const Eigen::VectorXd& plain(std::size_t j, std::size_t k) const { return at(j, k).plain; }

 private:
  struct Entry {
    Eigen::MatrixXd products;
    Eigen::VectorXd plain;
  };
  const Entry& at(std::size_t j, std::size_t k) const {
    return j < k ? at(k, j) : entries_[j * (j + 1) / 2 + k];
  }

  std::vector<Entry> entries_;  // j ≥ k, row by row
};

}  // namespace imunoise
