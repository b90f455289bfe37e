#pragma once

#include "core/inference/fit.h"
#include "core/inference/parameter_covariance.h"

namespace imunoise {

/// Confidence interval of one parameter from its standard error, on the scale that suits it.
ParameterEstimate interval(const ParameterInfo& info, bool power, double value, double standard_error,
                           double confidence);

/// Fills fit.parameters and fit.derived. `covariance` is of the interior parameters of the model, and
/// `zero_errors` the standard errors of the powers at zero, both in the order of `sets`.
void fill_intervals(Fit& fit, const ParameterSets& sets, const ParameterCovariance& covariance,
                    const std::vector<double>& zero_errors, Hertz rate);

}  // namespace imunoise
