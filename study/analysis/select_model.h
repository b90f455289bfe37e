#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/inference/model_choice.h"
#include "imunoise/v1/inference.pb.h"
#include "study/analysis/measure.h"

namespace imunoise::study {

struct SelectOptions {
  /// One model: it and all its sub-models are compared. Several: just these. None: kDefaultModel
  /// and its sub-models.
  std::vector<std::string> models;
  ChoiceOptions choice;
  MeasureOptions measure;
};

/// Chooses the model that predicts replicates it was not fitted to best. A single replicate is cut
/// into contiguous blocks, and the report says so. Error: as prepare(), a model that stands twice
/// in the list, a recording too short to cut, or more than 20 replicates to halve.
Result<v1::ChoiceReport> select_model(const Series& series, const SelectOptions& options,
                                      const Progress& progress = {});

/// The model to go on with: the simplest of which the data cannot say that it is worse than the
/// best; the best itself where every model is bad and "equivalent" means little.
const v1::CandidateModel& model_to_use(const v1::ChoiceReport& choice);

}  // namespace imunoise::study
