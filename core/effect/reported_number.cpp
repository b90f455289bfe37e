#include "core/effect/reported_number.h"

#include <cmath>

#include "core/support/distributions.h"

namespace imunoise {

double interval_reach() { return normal_quantile(0.975); }

ReportedNumber with_error(ReportedNumber to, double error) {
  if (!(error > 0.0) || !std::isfinite(error)) return to;
  to.lower = to.value - interval_reach() * error;
  to.upper = to.value + interval_reach() * error;
  return to;
}

ReportedNumber with_log_error(ReportedNumber to, double error) {
  if (!(error > 0.0) || !std::isfinite(error)) return to;
  to.lower = to.value * std::exp(-interval_reach() * error);
  to.upper = to.value * std::exp(interval_reach() * error);
  return to;
}

}  // namespace imunoise
