#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/array/array_estimate.h"
#include "imunoise/v1/faults.pb.h"
#include "study/analysis/series.h"

namespace imunoise::study {

struct FaultSeriesOptions {
  std::optional<std::string> model;  ///< in the grammar; unset: kDefaultArrayModel
  std::vector<std::vector<std::string>>
      groups;  ///< names of the sensors of each; the rest form one
  int per_octave = 1;
  Weighting weighting = Weighting::kFull;
  double false_alarms_per_hour = 0.01;
};

/// What a model of healthy noise is fitted to: one series a sensor.
struct Training {
  std::vector<Series> sensors;
  bool elsewhere = false;  ///< other recordings than those to search; else what is sound of these
};

/// Fits a model to static recordings of an array and searches `sensors` for one that steps, sticks
/// or grows noisy. Each is one series a sensor, of the same replicates. Error: as array_setup(),
/// training on other sensors or at another rate, a model without noise between the sensors, a rate
/// of false alarms that is not above zero, or the caller stopped it.
Result<v1::FaultReport> fault_series(const std::vector<Series>& sensors, const Training& training,
                                     const FaultSeriesOptions& options,
                                     const Progress& progress = {});

}  // namespace imunoise::study
