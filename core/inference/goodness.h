#pragma once

#include "core/inference/fit.h"

namespace imunoise {

/// Scales of a replicate with at least 5 exact equivalent degrees of freedom 2ν²/V_jj.
std::vector<bool> tested_scales(const Model& model, const WaveletVariance& wv,
                                const Eigen::MatrixXd& covariance);

/// The test of fit of one model to all replicates, on the tested scales.
GoodnessOfFit goodness_of_fit(const Model& model, std::span<const WaveletVariance> replicates,
                              const PerReplicate& covariances,
                              const std::vector<std::vector<bool>>& tested);

}  // namespace imunoise
