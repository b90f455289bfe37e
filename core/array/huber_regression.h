#pragma once

#include <Eigen/Core>

#include "core/array/banded_regression.h"

namespace imunoise {

/// Huber's regression (1964): residuals beyond 1.345 robust standard deviations of their series
/// (from the median absolute deviation) count linearly, so that single outliers cannot decide; 95 %
/// efficient on independent normal samples. Iteratively reweighted from ordinary least squares,
/// until the coefficients move by less than 1e-9 of themselves or after 200 rounds. It knows
/// nothing of coloured noise: its error comes from a bootstrap.
Eigen::VectorXd huber_regression(const RegressionData& data);

}  // namespace imunoise
