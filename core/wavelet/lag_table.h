#pragma once

#include <vector>

#include "core/wavelet/sum_covariance.h"

namespace imunoise {

/// The fast part of Γ at whole lags, worked out once for all pairs of scales. Covariances of
/// moments sum fast oscillations lag by lag, because no quadrature follows them; of a spread
/// resonance fifteen become one look-up.
class LagTable {
 public:
  /// Borrows nothing. Lags from `samples` on are never asked for.
  LagTable(const SumCovariance& process, std::size_t samples);

  /// Whether an exponential of the process, by its place, is in the table.
  bool holds(std::size_t exponential) const { return held_[exponential]; }
  /// Σ Re(k e^-Lh) over those it holds, k the factor of e^-L|s| in Γ; `lag` ≥ 0 is whole.
  double operator()(double lag) const {
    const auto h = static_cast<std::size_t>(lag);
    return h < sums_.size() ? sums_[h] : 0.0;
  }

 private:
  std::vector<bool> held_;
  std::vector<double> sums_;
};

}  // namespace imunoise
