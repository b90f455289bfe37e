#pragma once

#include "core/inference/goodness.h"

namespace imunoise {

/// Test of n residuals z of a model that was fitted by maximum likelihood to data that say at least
/// as much as they do. Before the fit they would be standard normal; the fit leaves them the
/// covariance I - A·J⁻¹·Aᵀ (Hausman 1978, Econometrica 46:1251), where A = -dz/dθ (n × parameters)
/// and J is Fisher's information (parameters × parameters). Directions of less than a tenth of
/// their variance are left out. With J = AᵀA it is the test of what no other parameters explain.
TestOutcome test_after_fit(const Eigen::VectorXd& z, const Eigen::MatrixXd& a,
                           const Eigen::MatrixXd& information);

}  // namespace imunoise
