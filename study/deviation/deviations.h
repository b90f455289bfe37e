#pragma once

#include "core/support/result.h"
#include "core/wavelet/deviation.h"
#include "imunoise/v1/deviation.pb.h"
#include "study/analysis/series.h"

namespace imunoise::study {

/// Overlapping Allan or Hadamard deviation at the customary averaging times, all replicates
/// together: variances weighted by the number of differences, degrees of freedom added. Error: no
/// replicate is long enough.
Result<v1::DeviationReport> deviations(const Series& series, DeviationKind kind, double confidence);

}  // namespace imunoise::study
