#pragma once

#include <cmath>

#include "core/support/random.h"

namespace imunoise {

/// x_t = a x_{t-1} + b x_{t-2} + e_t, from its stationary distribution: shared by all second-order
/// autoregressions.
class SecondOrderRecursion {
 public:
  /// `innovation`: standard deviation of e; `variance` and `covariance` of x at lags 0 and 1.
  SecondOrderRecursion(double a, double b, double innovation, double variance, double covariance,
                       RandomStream& rng)
      : a_(a), b_(b), innovation_(innovation), older_(std::sqrt(variance) * rng.normal()) {
    // A process without power has no past.
    const double along = variance > 0.0 ? covariance / variance : 0.0;
    newer_ = along * older_ + std::sqrt(variance - along * covariance) * rng.normal();
  }

  double next(RandomStream& rng) {
    const double now = older_;
    const double next = a_ * newer_ + b_ * older_ + innovation_ * rng.normal();
    older_ = newer_;
    newer_ = next;
    return now;
  }

 private:
  double a_;
  double b_;
  double innovation_;
  double older_;
  double newer_;
};

}  // namespace imunoise
