#pragma once

#include <utility>
#include <vector>

#include "core/process/contract.h"

namespace imunoise {

/// White noise through a filter with finitely many taps w: x_t = Σ_i w_i e_{t-i}, var e = 1. Shared
/// by MA(q) and the averaging filters. Shapes as in the contract.
class FiniteMemory {
 public:
  explicit FiniteMemory(std::vector<double> taps);
  /// The same where the autocovariance is known: sums take n² steps for n taps.
  FiniteMemory(std::vector<double> taps, std::vector<double> autocovariance)
      : taps_(std::move(taps)), gamma_(std::move(autocovariance)) {}

  const std::vector<double>& taps() const { return taps_; }
  /// γ(h) of the output, h = 0 .. taps - 1.
  const std::vector<double>& autocovariance() const { return gamma_; }

  /// ν(m) = [2mγ(0) + 2Σ_h c(h)γ(h)]/4m², c(h) = 2m - 3h for h < m, h - 2m for m ≤ h < 2m.
  Eigen::ArrayXd variance(HalfWidths m) const;
  /// dν / d tap k.
  Eigen::ArrayXd slope(HalfWidths m, std::size_t k) const;
  SumCovariance sum_covariance() const;

  class Recursion {
   public:
    double next(RandomStream& rng);

   private:
    friend FiniteMemory;
    Recursion(std::vector<double> taps, double sigma, RandomStream& rng);
    void take(double input);

    std::vector<double> taps_;
    double sigma_;
    std::vector<double> inputs_;  // twice over, so that the last ones always lie side by side
    std::size_t end_ = 0;         // behind the newest of the first half
  };
  /// One realisation, times sigma.
  Recursion recursion(double sigma, RandomStream& rng) const { return {taps_, sigma, rng}; }

 private:
  std::vector<double> taps_;
  std::vector<double> gamma_;
};

}  // namespace imunoise
