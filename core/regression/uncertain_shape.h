#pragma once

#include "core/regression/fitted_model.h"

namespace imunoise {

/// Factors, one a coefficient of the effect, by which their standard errors grow because the
/// effect's time constant (ShapeError::kLogarithm) is an estimate too; ones where it has none. In a
/// likelihood that is Gaussian near its maximum, the covariance of coefficients and time constant
/// is the inverse of their joint information (Seber & Wild 1989, Nonlinear Regression, chapter 2).
Eigen::ArrayXd growth_by_shape(const FittedEffect& effect);

}  // namespace imunoise
