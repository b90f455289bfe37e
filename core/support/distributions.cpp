#include "core/support/distributions.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/digamma.hpp>

namespace imunoise {

double chi_square_quantile(double probability, double dof) {
  return boost::math::quantile(boost::math::chi_squared(dof), probability);
}

double chi_square_tail(double value, double dof) {
  if (dof <= 0.0) return 1.0;
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(dof), value));
}

double normal_quantile(double probability) {
  return boost::math::quantile(boost::math::normal(), probability);
}

double student_quantile(double probability, double dof) {
  return boost::math::quantile(boost::math::students_t(dof), probability);
}

double digamma(double x) { return boost::math::digamma(x); }

}  // namespace imunoise
