#pragma once

#include <optional>

#include "imunoise/v1/array.pb.h"
#include "study/report/documents/document.h"

namespace imunoise::report {

/// Measured wavelet cross-covariances with their intervals and the model, as correlations: a small
/// panel for each pair of sensors, or for those that share noise where there are more than 24. For
/// page figures: both widths. Nothing without pairs.
std::optional<Figure> cross_chart(const v1::ArrayReport& report);

}  // namespace imunoise::report
