#pragma once

#include <Eigen/Core>

#include "core/support/linear_algebra.h"

namespace imunoise {

/// The response of a first-order lag of time constant `lag` samples > 0 to a series that stood at
/// its first value before: exact for a piecewise constant input.
Eigen::VectorXd lagged(const VectorRef& x, double lag);

/// Differences of neighbours times the sampling rate in Hz; the first is 0.
Eigen::VectorXd rate_of_change(const VectorRef& x, double rate);

}  // namespace imunoise
