#pragma once

#include <cmath>

namespace imunoise {

/// Mean power over its expectation, with so many degrees of freedom, as a number close to normal
/// (Wilson & Hilferty 1931).
inline double normal_score(double ratio, double dof) {
  const double spread = 2.0 / (9.0 * dof);
  return (std::cbrt(ratio) - (1.0 - spread)) / std::sqrt(spread);
}

}  // namespace imunoise
