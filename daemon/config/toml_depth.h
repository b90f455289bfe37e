#pragma once

#include <optional>
#include <string_view>

#include "daemon/config/problem.h"

namespace imunoise::config {

/// The first place of a TOML text that is nested deeper than any setting: a key of more than 16
/// parts, or lists and tables within one another more than 16 deep. A parser, which calls itself
/// for each level, would run out of its stack. Texts and comments are skipped as TOML 1.0 has them;
/// what is no TOML is left to the parser.
std::optional<Problem> too_deep(std::string_view text);

}  // namespace imunoise::config
