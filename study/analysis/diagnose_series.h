#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/support/progress.h"
#include "core/support/result.h"
#include "imunoise/v1/diagnosis.pb.h"
#include "study/analysis/prepared_channel.h"

namespace imunoise::study {

struct DiagnoseOptions {
  /// Noise and effects whose missing parts are sought, in the grammar; unset: see model_for().
  std::optional<std::string> model;
  std::vector<std::string> witnesses;  ///< names of channels; empty: all but the one diagnosed
  bool automatic = false;              ///< add what is found, and go on
  int forecasts = 0;                   ///< of so many candidates the next rung is worked out
  double level = 0.05;                 ///< chance of a false alarm over all candidates
};

/// Which effect the model of a channel lacks. Error: no such channel or witness, a model that
/// cannot be read, replicates that are too short or tell nothing, or the caller stopped it.
Result<v1::DiagnosisReport> diagnose_series(const std::vector<recording::Replicate>& recordings,
                                            std::size_t channel, const DiagnoseOptions& options,
                                            const Progress& progress = {});

/// The same of a channel that was looked at beside the witnesses that may be blamed;
/// `options.witnesses` is not used.
Result<v1::DiagnosisReport> diagnose_channel(const RecordedChannel& look,
                                             const DiagnoseOptions& options,
                                             const Progress& progress = {});

/// The model that select_model() chooses where none is named.
Result<std::string> model_for(const RecordedChannel& look, const Progress& progress = {});

}  // namespace imunoise::study
