#pragma once

#include <optional>
#include <string>

#include "core/inference/near_stationarity.h"
#include "imunoise/v1/inference.pb.h"
#include "study/analysis/measure.h"

namespace imunoise::study {

struct TestOptions {
  std::optional<std::string> model;  ///< in the grammar; unset: kDefaultModel
  BootstrapOptions bootstrap;
  MeasureOptions measure;
};

/// Tests whether the replicates are near-stationary under the model: misfit and heterogeneity, and
/// how each parameter differs between replicates. Error: as prepare(), fewer than two replicates,
/// or a bootstrap too small to reject anything.
Result<v1::StationarityReport> test_series(const Series& series, const TestOptions& options,
                                           const Progress& progress = {});

}  // namespace imunoise::study
