#pragma once

#include <string>
#include <vector>

#include "tests/hidden_effects/generator/effect.h"

namespace imunoise::hidden {

/// The ids that name what was hidden: its own first, then those that in these data are physically
/// the same thing. Nothing outside the catalogue, and nothing whose witness is withheld, has a
/// name.
std::vector<std::string> right_names(const HiddenEffect& effect, bool withheld);

}  // namespace imunoise::hidden
