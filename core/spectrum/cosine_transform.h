#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "core/support/linear_algebra.h"

namespace imunoise {

/// The longest length ≤ n that the transform is quick for: one without a prime factor above 13. At
/// least 96 % of any n ≥ 100, 98 % of any n ≥ 1,000.
std::size_t quick_length(std::size_t n);
/// The shortest such length ≥ n, n ≥ 1.
std::size_t next_quick_length(std::size_t n);

/// Orthonormal cosine transform (DCT-II) without its constant term: coefficient k = 1 … n-1 at
/// place k - 1, at the frequency k/2n cycles per sample, of x minus its mean: c_k = √(2/n) Σ_t x_t
/// cos(πk(t + ½)/n). Its vectors are the eigenvectors of a random walk of unknown start, so that
/// the coefficients of white noise plus a random walk are independent, with variances σ² + γ²/(4
/// sin²(πk/2n)) exactly; those of a stationary process are nearly so, with its spectrum. A Fourier
/// transform has neither: a walk leaks from its ends into every frequency. By one complex FFT of
/// length n (Makhoul 1980). Precondition: n is a quick_length().
Eigen::VectorXd cosine_transform(Eigen::VectorXd x);

/// The series of mean zero whose cosine_transform() is c: n samples of n - 1 coefficients.
Eigen::VectorXd inverse_cosine_transform(const VectorRef& c);
/// The same to 1e-6 of its root mean square, in less time and memory: for innovations.
Eigen::VectorXd rough_inverse_cosine_transform(const VectorRef& c);

}  // namespace imunoise
