#pragma once

// Noise sample by sample: what a process carries from one sample to the next. The same numbers as
// add_samples() from the same stream, which is made of these.

#include <cstddef>
#include <vector>

#include "core/process/ar1.h"
#include "core/process/resonance.h"
#include "core/support/random.h"

namespace imunoise {

/// x_t = φ x_{t-1} + e_t, from its stationary distribution.
class MarkovRecursion {
 public:
  MarkovRecursion(const Ar1& process, RandomStream& rng);
  double next(RandomStream& rng) {
    const double now = state_;
    state_ = phi_ * state_ + innovation_ * rng.normal();
    return now;
  }

 private:
  double phi_;
  double innovation_;
  double state_;
};

/// x_t = 2r cos ω x_{t-1} - r² x_{t-2} + e_t, from its stationary distribution.
class ResonanceRecursion {
 public:
  ResonanceRecursion(const Resonance& process, RandomStream& rng);
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

/// x_t = Σ_i w_i e_{t-i}, deviation of e: sigma.
class TapsRecursion {
 public:
  TapsRecursion(std::vector<double> taps, double sigma, RandomStream& rng);
  double next(RandomStream& rng);

 private:
  void take(double input);

  std::vector<double> taps_;
  double sigma_;
  std::vector<double> inputs_;  // twice over, so that the last ones always lie side by side
  std::size_t end_ = 0;         // behind the newest of the first half
};

}  // namespace imunoise
