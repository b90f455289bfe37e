#pragma once

// Recordings cut where a covariate stays, and measured there.

#include <string>
#include <vector>

#include "core/dynamic/covariate_bins.h"
#include "core/dynamic/dynamic_fit.h"
#include "study/analysis/measure.h"
#include "study/analysis/series.h"

namespace imunoise::study {

struct CovariateOptions {
  std::string channel;           ///< its name
  std::string unit{};            ///< what its numbers are called; empty: as the file says
  std::vector<double> values{};  ///< bins about these, in its unit
  std::size_t count = 0;         ///< or so many bins; neither: found from the data
  double settle_s = 0.0;         ///< left out at the start of each run, s
};

/// The covariate of every recording in its own unit, sorted into bins.
struct CovariateData {
  std::string name;
  std::string unit;  ///< "1" when none is stated
  Bins bins;
};

/// Error: no such channel, or fewer than two bins.
Result<CovariateData> covariate_data(const std::vector<recording::Replicate>& recordings,
                                     const CovariateOptions& options);

/// Wavelet variances of a channel's runs in every bin. Error: a bin in which the channel never
/// changes, or the caller stopped it.
Result<std::vector<CovariateBin>> measure_bins(const Series& series, const CovariateData& covariate,
                                               const MeasureOptions& options,
                                               const Progress& progress = {});

}  // namespace imunoise::study
