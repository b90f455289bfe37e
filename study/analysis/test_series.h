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

/// How each parameter differs between replicates.
void add_spread(const NearStationarity& result, Quantity quantity,
                google::protobuf::RepeatedPtrField<v1::ParameterSpread>& to);

/// "sigma2 of AR1 by 29 %, 1 - phi of AR1 by 40 %": those that differ beyond chance; empty: none.
std::string moving_words(const google::protobuf::RepeatedPtrField<v1::ParameterSpread>& spread);

}  // namespace imunoise::study
