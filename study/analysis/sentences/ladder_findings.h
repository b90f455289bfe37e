#pragma once

// What a whole ladder found: the effects that its last model kept, and how large they are.

#include <set>
#include <string>

#include "core/regression/fitted_model.h"
#include "imunoise/v1/diagnosis.pb.h"

namespace imunoise::study {

/// The models of a ladder, told apart by their terms, whatever their order and the values of the
/// noise.
class ModelsSeen {
 public:
  /// Whether the model was not seen before; it is from now on.
  bool is_new(const FullModel& model);

 private:
  std::set<std::multiset<std::string>> seen_;
};

/// Fills the findings of a report from its ladder, whose last model is `last`.
void add_findings(const FittedModel& last, v1::DiagnosisReport& to);

}  // namespace imunoise::study
