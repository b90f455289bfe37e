#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "imunoise/v1/dynamic.pb.h"
#include "recording/import/table/channel.h"
#include "study/analysis/covariate_data.h"

namespace imunoise::study {

inline constexpr std::string_view kDefaultDynamicModel = "QN + WN + RW";

struct DynamicOptions {
  CovariateOptions covariate;
  std::vector<std::string> channels;  ///< to analyse; empty: all but the covariate
  /// In the grammar with trends; unset: kDefaultDynamicModel. Where it names no trend, every power
  /// that it does not give follows the covariate exponentially.
  std::optional<std::string> model;
  MeasureOptions measure;
  double confidence = 0.95;
};

/// How the noise of each channel follows a covariate channel of the same recordings. Error: no such
/// channel, a covariate that does not move, a sensor that is stuck, a model that cannot be read or
/// has more free parameters than there are scales, or the caller stopped it.
Result<v1::DynamicReports> dynamic_channels(const std::vector<recording::Replicate>& recordings,
                                            const DynamicOptions& options,
                                            const Progress& progress = {});

}  // namespace imunoise::study
