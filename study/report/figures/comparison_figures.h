#pragma once

// The model beside the data as figures: spectrum, kurtosis, times, replicates, sensors, lags.

#include <optional>
#include <string>
#include <vector>

#include "imunoise/v1/diagnosis.pb.h"
#include "study/figure/figure.h"

namespace imunoise::report {

/// Power spectral density against the model's, with the waves that are candidates pointed at.
std::optional<figure::Figure> spectrum_figure(const v1::DiagnosisReport& report,
                                              const v1::Comparison& compared,
                                              const std::string& title);

/// Excess kurtosis of the whitened noise over averaging time.
std::optional<figure::Figure> kurtosis_figure(const v1::Comparison& compared);

/// Variance of the whitened noise over time, a row a replicate.
std::optional<figure::Figure> times_figure(const v1::Comparison& compared);

/// Residuals of each replicate at each averaging time.
std::optional<figure::Figure> deviations_figure(const v1::DiagnosisReport& report,
                                                const v1::Comparison& compared);

/// What channels share, and what each witness explains behind a lag.
std::vector<figure::Figure> witness_figures(const v1::Comparison& compared);

/// Every figure of a comparison but its spectrum. `report` is the one that holds it.
std::vector<figure::Figure> comparison_figures(const v1::DiagnosisReport& report,
                                               const v1::Comparison& compared);

}  // namespace imunoise::report
