#pragma once

#include <string_view>
#include <vector>

#include "core/model/model.h"
#include "study/analysis/measure.h"

namespace imunoise::study {

/// What every analysis of a series starts from.
struct Prepared {
  Model model;
  std::vector<WaveletVariance> measured;  ///< one a replicate
};

/// Reads a model for measured replicates. Error: where it cannot be read, or more free parameters
/// than there are scales.
Result<Model> read_model(std::string_view text, const std::vector<WaveletVariance>& measured);

/// Reads the model and measures the replicates. Error: as read_model(), or the caller stopped it.
Result<Prepared> prepare(const Series& series, std::string_view model,
                         const MeasureOptions& options, const Progress& progress = {});

/// Number of parameters that the user did not give.
std::size_t free_parameters(const Model& model);

}  // namespace imunoise::study
