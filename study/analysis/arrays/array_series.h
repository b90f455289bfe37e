#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/array/array_estimate.h"
#include "core/array/virtual_sensor.h"
#include "imunoise/v1/array.pb.h"
#include "study/analysis/measure.h"

namespace imunoise::study {

inline constexpr std::string_view kDefaultArrayModel = "AR1 + WN + RW[corr]";

struct ArraySeriesOptions {
  std::optional<std::string> model;  ///< in the grammar; unset: kDefaultArrayModel
  std::vector<std::vector<std::string>>
      groups;         ///< names of the sensors of each; the rest form one
  bool cross = true;  ///< use the cross-covariances
  int per_octave = 1;
  Weighting weighting = Weighting::kFull;
  bool efficient = false;  ///< carry the fit on to the maximum of Whittle's likelihood
  double confidence = 0.95;
  /// What the virtual sensor is to be quiet at: "short" (the three shortest averaging times),
  /// "long" (the three longest), "all", or one weight a scale, separated by commas.
  std::string scales = "all";
  WeightRule rule = WeightRule::kUnitGain;
};

/// Fits one model to all sensors of an array, tests which of them share noise, and makes the best
/// virtual sensor of them. `sensors` is one series a sensor, of the same replicates. Error: fewer
/// than two sensors, sensors of different quantities, a model, group or list that cannot be read,
/// a model without a likelihood or sensors too short for it, or the caller stopped it.
Result<v1::ArrayReport> array_series(const std::vector<Series>& sensors,
                                     const ArraySeriesOptions& options,
                                     const Progress& progress = {});

}  // namespace imunoise::study
