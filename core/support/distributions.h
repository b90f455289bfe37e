#pragma once

// The few distribution functions the house needs. Boost.Math is slow to compile: it stays behind
// this door.

namespace imunoise {

/// Quantile of the χ² law with `dof` > 0 degrees of freedom (need not be whole), 0 < probability
/// < 1.
double chi_square_quantile(double probability, double dof);

/// P(χ²_dof > value); 1 when dof is zero.
double chi_square_tail(double value, double dof);

/// Quantile of the standard normal law, 0 < probability < 1.
double normal_quantile(double probability);

/// Quantile of Student's law with `dof` > 0 degrees of freedom, 0 < probability < 1.
double student_quantile(double probability, double dof);

/// ψ(x), the logarithmic derivative of the gamma function, x > 0.
double digamma(double x);

}  // namespace imunoise
