#pragma once

// The few distribution functions the house needs. Boost.Math is slow to compile: it stays behind
// this door.

namespace imunoise {

/// Quantile of the χ² law with `dof` > 0 degrees of freedom (need not be whole), 0 < probability
/// < 1.
double chi_square_quantile(double probability, double dof);

/// P(χ²_dof > value); 1 when dof is zero.
double chi_square_tail(double value, double dof);

/// log P(χ²_dof > value), also where the probability is too small for a double; dof > 0.
double log_chi_square_tail(double value, double dof);

/// log P(F > value) for Fisher's law with (first, second) degrees of freedom, both > 0; also where
/// the probability is too small for a double.
double log_f_tail(double value, double first, double second);

/// Quantile of the standard normal law, 0 < probability < 1.
double normal_quantile(double probability);

/// P(x > value) of the standard normal law.
double normal_tail(double value);

/// Quantile of Student's law with `dof` > 0 degrees of freedom, 0 < probability < 1.
double student_quantile(double probability, double dof);

/// ψ(x), the logarithmic derivative of the gamma function, x > 0.
double digamma(double x);

}  // namespace imunoise
