#pragma once

#include <span>

#include "core/estimate/whittle.h"
#include "core/inference/fit.h"

namespace imunoise {

/// A fit of moments carried on to the maximum of Whittle's likelihood of the same replicates:
/// estimate, residuals and intervals (from the Fisher information) are of that. The test of fit
/// stays the one of the moments: it is about the model, not about the estimate.
Fit make_efficient(Fit fit, std::span<const WaveletVariance> replicates,
                   std::span<const BandedPower> powers, const Progress& progress = {});

/// Fills the intervals of a fit whose model is set, at the maximum of Whittle's likelihood of these
/// powers: from the Fisher information.
void fill_likelihood_intervals(Fit& fit, std::span<const BandedPower> powers);

}  // namespace imunoise
