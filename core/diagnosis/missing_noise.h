#pragma once

#include "core/regression/current.h"
#include "core/search/suggestion.h"

namespace imunoise {

/// The causes of noise that a model can miss.
std::vector<Cause> noise_causes();

/// More noise: white, quantisation, flicker, a walk, a Markov process or a resonance anywhere, and
/// white noise through averaging filters.
Suggestions search_noise(const Current& current);

/// What only the fit of more noise shows: a better name, whether heat could have made it, and
/// whether it is there all the time.
void review_noise(const Current& current, TriedTerm& tried);

}  // namespace imunoise
