#pragma once

#include <span>

#include "core/effect/effect.h"
#include "core/search/suggestion.h"

namespace imunoise {

/// What these effects explain of what a model leaves, in their order.
Suggestions search_effects(const Current& current, std::span<const Effect* const> effects,
                           const Progress& progress = {});

/// Noise, then each known effect.
Suggestions search_all(const Current& current, const Progress& progress = {});

}  // namespace imunoise
