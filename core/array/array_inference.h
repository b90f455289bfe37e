#pragma once

#include <functional>
#include <vector>

#include "core/array/array_blocks.h"
#include "core/array/array_estimate.h"
#include "core/inference/parameter_covariance.h"

namespace imunoise {

/// Every free parameter of a model, without its estimate. The entries of a matrix of powers come
/// together, in the order of packed_index().
std::vector<ArrayParameter> parameters_of(const ArrayModel& model);
double value_of(const ArrayModel& model, const ArrayParameter& parameter);
void set_value(ArrayModel& model, const ArrayParameter& parameter, double value);

/// Covariance of a fit's parameters, were the noise that of the model given, which differs from the
/// fit's in its powers alone.
using CovarianceUnder = std::function<ParameterCovariance(const ArrayModel& scatter)>;

/// Fills the estimates of fit.parameters, which are there, and their covariance: intervals on the
/// scale that suits each. `samples`: of all replicates.
void fill_estimates(ArrayFit& fit, double confidence, double samples,
                    const CovarianceUnder& covariance_under);

/// Fills the parameters of a fit and their covariance: the sandwich H⁻¹BH⁻¹ with the exact
/// covariance of the moments. The blocks and the weight roots are those of the estimate.
void infer(ArrayFit& fit, const std::vector<ArrayBlock>& blocks,
           const std::vector<Eigen::MatrixXd>& roots, double confidence);

}  // namespace imunoise
