#pragma once

// The Haar wavelet variance of γ(h) = Re(A z^|h|), shared by the Markov process (z real) and the
// resonance (z complex), in a form that never cancels.

#include <cmath>
#include <complex>

#include "core/wavelet/sum_covariance_terms.h"

namespace imunoise {

/// g(x) = 2x - 3 + 4e^-x - e^-2x = 2x³/3 - x⁴/2 + ...
template <class Scalar>
Scalar wavelet_remainder(Scalar x) {
  if (std::abs(x) > 1.0) return 2.0 * x - 3.0 + 4.0 * std::exp(-x) - std::exp(-2.0 * x);
  Scalar power = -x * x * x / 6.0;
  Scalar sum{};
  double two = 8.0;
  for (int k = 3; k < 30; ++k) {
    const Scalar term = power * (4.0 - two);
    sum += term;
    if (std::abs(term) < 1e-18 * std::abs(sum)) break;
    power *= -x / static_cast<double>(k + 1);
    two *= 2.0;
  }
  return sum;
}

/// With L = -log z: K(m) = [m(1-z²) - z(3 - 4z^m + z^2m)] / [2m²(1-z)²], so that ν(m) = Re(A·K(m)),
/// and its logarithmic derivative d ln K / dL.
template <class Scalar>
struct ExponentialShape {
  Scalar value;
  Scalar log_derivative;
};

template <class Scalar>
ExponentialShape<Scalar> exponential_shape(Scalar rate, double m) {
  // z / (1-z)² = 1 / (4 sinh²(L/2)); m(1-z²)/z = 2m sinh L.
  const Scalar half = std::sinh(0.5 * rate);
  const Scalar numerator = 2.0 * m * sinh_minus_argument(rate) + wavelet_remainder(m * rate);
  const Scalar once = stable_expm1(-m * rate);
  const Scalar slope = 4.0 * m * half * half + 2.0 * m * once * once;
  return {numerator / (8.0 * m * m * half * half),
          slope / numerator - std::cosh(0.5 * rate) / half};
}

}  // namespace imunoise
