#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/array/mixed_regression.h"
#include "imunoise/v1/mixed.pb.h"
#include "study/analysis/series.h"

namespace imunoise::study {

inline constexpr std::string_view kDefaultMixedModel = "AR1[all] + AR1 + WN";

struct MixedSeriesOptions {
  std::optional<std::string> model;  ///< of the noise, in the grammar; unset: kDefaultMixedModel
  /// Each "CHANNEL" (the same for all series), "time" (a trend per second), or "NAME=a,b,c" (one
  /// channel a series, in their order).
  std::vector<std::string> regressors;
  std::vector<std::vector<std::string>> groups;  ///< names of the series of each; the rest form one
  RegressionOptions regression;
};

/// Regresses series on others, with noise that series may share. `channels` are those of one
/// recording; those that no regressor names are the responses. Error: no regressor or no response,
/// a regressor that does not exist or never changes, responses of different quantities, a model or
/// group that cannot be read, or the caller stopped it.
Result<v1::MixedReport> mixed_series(const std::vector<Series>& channels,
                                     const MixedSeriesOptions& options,
                                     const Progress& progress = {});

}  // namespace imunoise::study
