#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/model/model.h"
#include "study/analysis/measure.h"

namespace imunoise::study {

/// The model of an analysis whose user names none.
inline constexpr std::string_view kDefaultModel = "2*AR1 + WN + RW";

/// What to tell that user; `done` says what was done with it: "was fitted".
std::string default_model_note(std::string_view done, std::string_view model = kDefaultModel);

/// What every analysis of a series starts from.
struct Prepared {
  Model model;
  std::vector<WaveletVariance> measured;  ///< one a replicate
};

/// Reads a model for measured replicates. Error: where it cannot be read, or more free parameters
/// than there are scales.
Result<Model> read_model(std::string_view text, const std::vector<WaveletVariance>& measured);

/// Error: what looks like a replicate but tells nothing new: one that never changes, or two with
/// the same samples. `measured` are those of the series.
Result<void> check_replicates(const Series& series, const std::vector<WaveletVariance>& measured);

/// Error: more free parameters than the longest replicate has scales.
Result<void> enough_scales(const Model& model, const std::vector<WaveletVariance>& measured);

/// Reads the model and measures the replicates. Error: as read_model(), a replicate that never
/// changes, two with the same samples, or the caller stopped it.
Result<Prepared> prepare(const Series& series, std::string_view model,
                         const MeasureOptions& options, const Progress& progress = {});

/// Number of parameters that the user did not give.
std::size_t free_parameters(const Model& model);

}  // namespace imunoise::study
