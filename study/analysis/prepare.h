#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/effects/parse_full_model.h"
#include "study/analysis/less_effects.h"
#include "study/analysis/measure.h"

namespace imunoise::study {

/// The model of an analysis whose user names none.
inline constexpr std::string_view kDefaultModel = "2*AR1 + WN + RW";

/// What to tell that user; `done` says what was done with it: "was fitted".
std::string default_model_note(std::string_view done, std::string_view model = kDefaultModel);

/// What every analysis of a series starts from.
struct Prepared {
  LessEffects left;                       ///< the series and the model's noise
  std::vector<WaveletVariance> measured;  ///< one a replicate of what is left
};

/// Error: what looks like a replicate but tells nothing new: one that never changes, or two with
/// the same samples. `measured` are those of the series.
Result<void> check_replicates(const Series& series, const std::vector<WaveletVariance>& measured);

/// Error: a model without noise, or with more free parameters than the longest replicate has
/// scales.
Result<void> can_be_fitted(const Model& model, const std::vector<WaveletVariance>& measured);

/// The wavelet variance of each replicate. Error: as check_replicates(), or the caller stopped it.
Result<std::vector<WaveletVariance>> measured_replicates(const Series& series,
                                                         const MeasureOptions& options,
                                                         const Progress& progress = {});

/// Reads a model, takes its effects out of the replicates, and measures what they leave. Error: a
/// model that cannot be read, or as take_out_effects().
Result<Prepared> prepare(const Series& series, std::string_view model, const Grammar& grammar,
                         const MeasureOptions& options, const Progress& progress = {});

/// Number of parameters that the user did not give.
std::size_t free_parameters(const Model& model);

}  // namespace imunoise::study
