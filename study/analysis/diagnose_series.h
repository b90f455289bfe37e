#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/support/progress.h"
#include "core/support/result.h"
#include "imunoise/v1/diagnosis.pb.h"
#include "recording/import/channel.h"

namespace imunoise::study {

struct DiagnoseOptions {
  /// Noise and effects whose missing parts are sought, in the grammar; unset: chosen by CV-WVIC.
  std::optional<std::string> model;
  std::vector<std::string> witnesses;  ///< names of channels; empty: all but the one diagnosed
  bool automatic = false;              ///< add what is found, and go on
  bool search = true;                  ///< false: fit the model and judge it, seek nothing
  int foretold = 0;                    ///< of so many candidates the next rung is worked out
  double level = 0.05;                 ///< chance of a false alarm over all candidates
};

/// Which effect the model of a channel lacks. Error: no such channel or witness, a model that
/// cannot be read, replicates that are too short or tell nothing, or the caller stopped it.
Result<v1::DiagnosisReport> diagnose_series(const std::vector<recording::Replicate>& recordings,
                                            std::size_t channel, const DiagnoseOptions& options,
                                            const Progress& progress = {});

}  // namespace imunoise::study
