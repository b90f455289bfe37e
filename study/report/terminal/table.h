#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "study/words/terminal_style.h"

namespace imunoise::report {

/// Words broken into lines no wider than the terminal, each after `indent` spaces.
std::string wrapped(std::string_view text, int indent, const TerminalStyle& style);

/// Rows of cells in aligned columns, which are as wide as their contents; where the terminal is too
/// narrow, cells continue below themselves, those of the widest columns first.
std::string terminal_table(const std::vector<std::string>& head,
                           const std::vector<std::vector<std::string>>& rows,
                           const TerminalStyle& style);

}  // namespace imunoise::report
