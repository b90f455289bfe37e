#pragma once

#include <optional>
#include <vector>

#include "core/inference/fit.h"

namespace imunoise {

/// Where to start the search for trends: the bins' separate fits (at covariates in [-1, 1]; none
/// where a bin has none) regressed on the covariate, each parameter on the scale of its link and
/// weighted by its standard error; and the same without slopes. Only shapes and slopes are set.
std::vector<Model> trend_starts(const Model& open, const std::vector<double>& covariates,
                                const std::vector<std::optional<Fit>>& separate);

}  // namespace imunoise
