#include "core/support/distributions.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <cmath>
#include <numbers>

namespace imunoise {

double chi_square_quantile(double probability, double dof) {
  return boost::math::quantile(boost::math::chi_squared(dof), probability);
}

double chi_square_tail(double value, double dof) {
  if (dof <= 0.0) return 1.0;
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(dof), value));
}

namespace {

// Below this a tail is told by the first term of its expansion, which is then exact to 1 %.
constexpr double kSmallestTail = 1e-250;

}  // namespace

double log_chi_square_tail(double value, double dof) {
  const double tail = chi_square_tail(value, dof);
  if (tail > kSmallestTail) return std::log(tail);
  // Γ(a, x) ~ x^(a-1) e^-x (1 + (a-1)/x): Abramowitz & Stegun 6.5.32.
  const double a = 0.5 * dof;
  const double x = 0.5 * value;
  return (a - 1.0) * std::log(x) - x + std::log1p((a - 1.0) / x) - std::lgamma(a);
}

double log_f_tail(double value, double first, double second) {
  if (value <= 0.0) return 0.0;
  const double tail =
      boost::math::cdf(boost::math::complement(boost::math::fisher_f(first, second), value));
  if (tail > kSmallestTail) return std::log(tail);
  // The tail is the incomplete beta function of x = n/(n + dF) ≪ 1: A & S 26.5.4, first term.
  const double a = 0.5 * second;
  const double b = 0.5 * first;
  const double log_x = -std::log1p(first * value / second);
  const double log_beta = std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
  return a * log_x + b * std::log1p(-std::exp(log_x)) - std::log(a) - log_beta;
}

double normal_quantile(double probability) {
  // Without a detour by long double, which takes four times as long and adds no digit that counts.
  using boost::math::policies::policy;
  using boost::math::policies::promote_double;
  const boost::math::normal_distribution<double, policy<promote_double<false>>> normal;
  return boost::math::quantile(normal, probability);
}

double normal_tail(double value) { return 0.5 * std::erfc(value / std::numbers::sqrt2); }

double student_quantile(double probability, double dof) {
  return boost::math::quantile(boost::math::students_t(dof), probability);
}

double digamma(double x) { return boost::math::digamma(x); }

}  // namespace imunoise
