#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace imunoise {

/// One component γ(h) = Re(amplitude · root^|h|) of an autocovariance, |root| < 1.
struct ExponentialCovariance {
  std::complex<double> amplitude;
  std::complex<double> root;
  std::complex<double>
      log_root;  ///< log(root), given apart because root near 1 has lost its digits
  std::complex<double> one_minus_root;
};

/// Covariance of the prefix sums S of a noise process, Γ(s) with Γ(s+1) - 2Γ(s) + Γ(s-1) = -γ(s),
/// up to even polynomials that every Haar wavelet ignores. All the wavelet moments of a Gaussian
/// process follow from it: E[W_{j,t+s} W_{k,t}] = Σ_ab p_a p_b Γ(s - a m_j + b m_k) / (4 m_j m_k),
/// p = (1,-2,1). Sums of independent processes add. This closed form covers every process of the
/// house:
///   Γ(s) = linear·|s| + cubic·|s|³ + near[|s|] + Σ exponentials + flicker·Φ(s),
/// and a deterministic ramp contributes mean wavelet coefficients slope·m/2.
struct SumCovariance {
  double linear = 0.0;
  double cubic = 0.0;
  std::vector<double> near{};  ///< zero at and beyond near.size()
  std::vector<ExponentialCovariance> exponentials{};
  double flicker = 0.0;  ///< B²; Φ(s) = (2/π) Σ_{h<s} (s-h)·O_h, O_h = Σ_{i≤h} 1/(2i-1)
  double slope_squared = 0.0;  ///< ω², per sample

  SumCovariance& operator+=(const SumCovariance& other);
  /// The same process with all variances multiplied.
  SumCovariance scaled(double power) const;
};

}  // namespace imunoise
