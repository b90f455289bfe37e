#pragma once

#include <string>
#include <vector>

#include "core/array/banded_regression.h"
#include "core/support/result.h"
#include "study/analysis/series.h"

namespace imunoise::study {

/// What is regressed on what.
struct Regression {
  std::vector<Series> responses;
  std::vector<std::string> names;  ///< of the regressors
  std::vector<std::string> units;  ///< of their coefficients
  RegressionData data;
};

/// The channels that regressors name.
std::vector<std::string> channels_of(const std::vector<std::string>& texts);

/// Reads regressors as `imunoise mixed --regress` takes them, see MixedSeriesOptions. Error: one
/// that does not exist, that never changes or is named twice, some that depend on each other
/// linearly, or nothing to regress.
Result<Regression> read_regressors(const std::vector<Series>& channels,
                                   const std::vector<std::string>& texts);

}  // namespace imunoise::study
