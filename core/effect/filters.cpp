#include "core/effect/filters.h"

#include <cmath>

namespace imunoise {

Eigen::VectorXd lagged(const VectorRef& x, double lag) {
  const double keep = std::exp(-1.0 / lag);
  Eigen::VectorXd out(x.size());
  double state = x.size() > 0 ? x(0) : 0.0;
  for (Eigen::Index t = 0; t < x.size(); ++t) {
    state = keep * state + (1.0 - keep) * x(t);
    out(t) = state;
  }
  return out;
}

Eigen::VectorXd rate_of_change(const VectorRef& x, double rate) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(x.size());
  out.tail(x.size() - 1) = rate * (x.tail(x.size() - 1) - x.head(x.size() - 1));
  return out;
}

}  // namespace imunoise
