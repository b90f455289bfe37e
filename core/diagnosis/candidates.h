#pragma once

#include "core/regression/current.h"
#include "core/search/suggestion.h"

namespace imunoise {

/// The current model with a suggestion added, fitted as one.
FittedModel fit_with(const Current& current, const Suggestion& suggestion);

/// Sorts by gain; equals stay in order.
void best_first(std::vector<TriedTerm>& tried);

/// Every suggestion that is worth it, tried on the current model, best first.
std::vector<TriedTerm> try_all(const Current& current, const Suggestions& suggestions,
                               const Progress& progress = {});

}  // namespace imunoise
