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

/// Every figure of a comparison but its spectrum. `report` is the one that holds it.
std::vector<figure::Figure> comparison_figures(const v1::DiagnosisReport& report,
                                               const v1::Comparison& compared);

}  // namespace imunoise::report
