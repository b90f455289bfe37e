#pragma once

// A model beside the data: what every figure of a diagnosis shows.

#include <string>
#include <vector>

#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/views/left_over.h"
#include "imunoise/v1/diagnosis.pb.h"

namespace imunoise::study {

/// Spectrum, kurtosis, times, replicates, pairs of channels and lags of a fitted model. `left`:
/// left_over() of it; `replicates` are their names, `channel` that of the one under study.
v1::Comparison comparison_of(const FittedModel& trial, const LeftOver& left,
                             const std::string& channel,
                             const std::vector<std::string>& replicates);

}  // namespace imunoise::study
