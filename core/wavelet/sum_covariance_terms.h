#pragma once

// Stable pieces of Γ(s) for exponential and flicker covariances, shared by the wavelet variance of
// a process and by the covariance of moments.

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/support/distributions.h"

namespace imunoise {

/// exp(x) - 1 without cancellation.
inline double stable_expm1(double x) { return std::expm1(x); }
inline std::complex<double> stable_expm1(std::complex<double> x) {
  const double half = std::sin(0.5 * x.imag());
  return {std::expm1(x.real()) * std::cos(x.imag()) - 2.0 * half * half,
          std::exp(x.real()) * std::sin(x.imag())};
}

/// e^-x - 1 + x - x²/2 + x³/6 = x⁴/24 - ..., without cancellation for small |x|, Re x ≥ 0.
template <class Scalar>
Scalar exponential_remainder(Scalar x) {
  if (std::abs(x) > 1.0) return std::exp(-x) - 1.0 + x * (1.0 - x * (0.5 - x / 6.0));
  // x⁴/4! (1 - x/5 (1 - x/6 (1 - ...))), to double precision for |x| ≤ 1.
  constexpr std::array<double, 14> kInverse = {1.0 / 5,  1.0 / 6,  1.0 / 7,  1.0 / 8,  1.0 / 9,
                                               1.0 / 10, 1.0 / 11, 1.0 / 12, 1.0 / 13, 1.0 / 14,
                                               1.0 / 15, 1.0 / 16, 1.0 / 17, 1.0 / 18};
  Scalar sum = 1.0;
  for (std::size_t k = kInverse.size(); k-- > 0;) sum = 1.0 - x * kInverse[k] * sum;
  return x * x * x * x / 24.0 * sum;
}

/// sinh(x) - x = x³/6 + ..., without cancellation for small |x|.
template <class Scalar>
Scalar sinh_minus_argument(Scalar x) {
  if (std::abs(x) > 1.0) return std::sinh(x) - x;
  Scalar term = x * x * x / 6.0;
  Scalar sum = term;
  for (int k = 5; k < 22 && std::abs(term) > 1e-18 * std::abs(sum); k += 2) {
    term *= x * x / static_cast<double>(k * (k - 1));
    sum += term;
  }
  return sum;
}

/// ψ(s + 1/2), s ≥ 0. From 32 on by its expansion in 1/s² (Abramowitz & Stegun 6.3.18 at s + 1/2,
/// with Bernoulli polynomials at 1/2), whose next term is below 1e-19: sums over lags take
/// millions.
inline double digamma_of_half_beyond(double s) {
  constexpr double kFar = 32.0;
  if (s < kFar) return digamma(s + 0.5);
  constexpr std::array<double, 5> kTerms = {1.0 / 24, -7.0 / 960, 31.0 / 8064, -127.0 / 30720,
                                            511.0 / 67584};
  const double x = 1.0 / (s * s);
  double sum = 0.0;
  for (std::size_t k = kTerms.size(); k-- > 0;) sum = x * (kTerms[k] + sum);
  return std::log(s) + sum;
}

/// Φ(s) of flicker noise of unit B² (Kasdin's half-integrated white noise), up to an even
/// polynomial: (s² - 1/4) ψ(s + 1/2) / 2π, s ≥ 0.
inline double flicker_sum_covariance(double s) {
  return (s * s - 0.25) * digamma_of_half_beyond(s) / (2.0 * std::numbers::pi);
}

}  // namespace imunoise
