#pragma once

#include <span>

#include "core/inference/fit.h"
#include "core/inference/normal_scores.h"

namespace imunoise {

/// Fills fit.residuals and fit.tested from fit.estimate and fit.covariances.
void fill_residuals(Fit& fit, std::span<const WaveletVariance> replicates,
                    const PerReplicate<NormalScores>& scores);

}  // namespace imunoise
