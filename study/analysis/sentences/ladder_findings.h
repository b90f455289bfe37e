#pragma once

// What a whole ladder found: the effects that its last model kept, and how large they are.

#include <optional>
#include <set>
#include <string>
#include <vector>

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

/// Fills the findings of a report from its ladder, whose last model is `last`. `noise`: what each
/// rung added, as it was fitted there; nothing where it added none.
void add_findings(const FittedModel& last, const std::vector<std::optional<Process>>& noise,
                  v1::DiagnosisReport& to);

}  // namespace imunoise::study
