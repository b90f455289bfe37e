#pragma once

#include <optional>

#include "imunoise/v1/array.pb.h"
#include "study/figure/figure.h"

namespace imunoise::report {

/// Measured wavelet cross-covariances with their intervals and the model, as correlations: a small
/// panel for each pair of sensors, or for those that share noise where there are more than 24.
/// Nothing without pairs.
std::optional<figure::Figure> cross_figure(const v1::ArrayReport& report);

}  // namespace imunoise::report
