#pragma once

#include <optional>
#include <vector>

#include "core/support/progress.h"
#include "core/support/result.h"
#include "core/wavelet/robust_variance.h"
#include "core/wavelet/wavelet_variance.h"
#include "imunoise/v1/noise.pb.h"
#include "study/analysis/series.h"

namespace imunoise::study {

struct MeasureOptions {
  int per_octave = 1;                      ///< scales an octave: 1, 2 or 4
  std::optional<RobustEfficiency> robust;  ///< unset: the classical estimator
  double confidence = 0.95;                ///< of the intervals, which make the diagonal weights
};

/// Wavelet variance of every replicate. Error: the caller stopped it.
Result<std::vector<WaveletVariance>> measure(const Series& series, const MeasureOptions& options,
                                             const Progress& progress = {});

/// One curve out of several replicates: at each scale the average weighted by the number of
/// coefficients, over the replicates that reach it; degrees of freedom add up.
WaveletVariance pooled(const std::vector<WaveletVariance>& replicates);

/// The measured curves as a message.
v1::WaveletVarianceReport wavelet_report(const Series& series,
                                         const std::vector<WaveletVariance>& measured);

}  // namespace imunoise::study
