#pragma once

#include "core/regression/current.h"
#include "core/search/suggestion.h"

namespace imunoise {

/// The current model with a suggestion added, fitted as one.
FittedModel fit_with(const Current& current, const Suggestion& suggestion);

/// Sorts by gain; equals stay in order.
void best_first(std::vector<TriedTerm>& tried);

/// Evidence if the fit bears the search out, nats.
double promised(const Suggestion& one);

/// A share of what is taken: less may look otherwise once that is in the model.
inline constexpr double kMasked = 0.01;

/// Every suggestion that is worth it, tried on the current model, best first. What promises less
/// than the best masks is not worth it.
std::vector<TriedTerm> try_all(const Current& current, const Suggestions& suggestions,
                               const Progress& progress = {});

}  // namespace imunoise
