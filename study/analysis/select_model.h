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
  /// and its sub-models, and from the best of them on as `search_on` says.
  std::vector<std::string> models;
  /// Also models that add flicker, quantisation noise or a ramp to the best, or put one in the
  /// place of another term.
  bool search_on = false;
  ChoiceOptions choice;
  MeasureOptions measure;
};

/// Chooses the simplest model whose held-out likelihood (Whittle) is within 3 nats of the best, and
/// compares the models by their held-out error (CV-WVIC), too. Of a single replicate, the
/// likelihood holds out a sixth of its bands at a time, and the error one of six contiguous blocks;
/// the report says so. Error: as prepare(), a model that stands twice in the list, a recording too
/// short to cut, or more than 20 replicates to halve.
Result<v1::ChoiceReport> select_model(const Series& series, const SelectOptions& options,
                                      const Progress& progress = {});

/// The text of the model that model_to_use() takes from select_model(). Where the held-out
/// likelihood decides, CV-WVIC is not computed. Errors as there.
Result<std::string> chosen_model(const Series& series, const SelectOptions& options,
                                 const Progress& progress = {});

/// The model to go on with: the one that the held-out likelihood chose. Where replicates are too
/// short for that, and in files of earlier versions: the simplest of which CV-WVIC cannot say that
/// it is worse than the best; the best itself where every model is bad and "equivalent" means
/// little.
const v1::CandidateModel& model_to_use(const v1::ChoiceReport& choice);

}  // namespace imunoise::study
