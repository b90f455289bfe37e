#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/array/array_estimate.h"
#include "imunoise/v1/array.pb.h"
#include "study/analysis/series.h"

namespace imunoise::study {

/// "RW[corr]", "AR1 (2)".
std::string array_label(const Model& written, std::size_t term);

/// The parameters of an array's fit as messages, in their order.
std::vector<v1::ArrayParameter> array_parameters(const ArrayFit& fit, const Model& written,
                                                 const std::vector<Series>& sensors,
                                                 double confidence);

}  // namespace imunoise::study
