#pragma once

#include <vector>

#include "core/estimate/estimators.h"
#include "imunoise/v1/noise.pb.h"

namespace imunoise::study {

/// The pooled curve of some replicates against a model. Its spread at each scale follows from the
/// exact covariance of each replicate. `tested` has a row a replicate: the scales that a test of
/// the fit uses.
v1::NoiseBudget noise_budget(const Model& noise, const std::vector<WaveletVariance>& measured,
                             const MomentCovariances& covariances,
                             const std::vector<std::vector<bool>>& tested, double confidence);

}  // namespace imunoise::study
