#pragma once

#include <vector>

#include "core/support/random.h"

namespace imunoise {

/// Flicker noise sample by sample, in bounded memory: the half-integrator's impulse response
/// h_k = Γ(k + 1/2) / (√π k!) = 1/π ∫ x^(k+1/2) (1-x)^(1/2) du, x = 1 / (1 + e^(-u)), as a sum over
/// u in steps of one (the trapezoidal rule, here good to 2e-4), which is a bank of first-order
/// filters that share their input. Its memory ends near 1e10 samples: from there on it is
/// stationary.
class FlickerRecursion {
 public:
  FlickerRecursion(double b2, RandomStream& rng);
  double next(RandomStream& rng);

  /// h_0 .. h_(n-1) of this bank.
  std::vector<double> impulse_response(std::size_t n) const;

 private:
  struct Filter {
    double weight;
    double decay;
    double state;
  };

  double sigma_;
  double direct_ = 1.0;  // h_0 less the weights: filters too short to be in the bank
  std::vector<Filter> filters_;
};

}  // namespace imunoise
