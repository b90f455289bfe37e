#pragma once

#include <vector>

#include "core/array/array_blocks.h"
#include "core/array/array_estimate.h"

namespace imunoise {

/// Fills the parameters of a fit and their covariance: the sandwich H⁻¹BH⁻¹ with the exact
/// covariance of the moments, intervals on the scale that suits each parameter. The blocks and the
/// weight roots are those of the estimate.
void infer(ArrayFit& fit, const std::vector<ArrayBlock>& blocks,
           const std::vector<Eigen::MatrixXd>& roots, double confidence);

}  // namespace imunoise
