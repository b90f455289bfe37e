#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/effect/effect.h"

namespace imunoise {

/// Every effect, in the order of the documentation: what the grammar knows and what is searched.
std::span<const Effect* const> known_effects();
/// The effect of this name, in lower case; null where there is none.
const Effect* effect_called(std::string_view name);
/// Precondition: an effect of this name.
const Effect& effect_named(std::string_view name);

}  // namespace imunoise
