#pragma once

// The model beside the data as figures: spectrum, kurtosis, times, replicates, sensors, lags.

#include "imunoise/v1/diagnosis.pb.h"
#include "study/report/curve_chart.h"
#include "study/report/heat_map.h"

namespace imunoise::report {

/// Power spectral density against the model's, with the waves that are candidates pointed at.
CurveChart spectrum_chart(const v1::DiagnosisReport& report, const v1::Comparison& compared,
                          const std::string& title);

/// Every figure of a comparison but its spectrum. `report` is the one that holds it.
std::vector<Figure> comparison_figures(const v1::DiagnosisReport& report,
                                       const v1::Comparison& compared);

}  // namespace imunoise::report
