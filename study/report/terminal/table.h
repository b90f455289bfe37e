#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "study/report/terminal_canvas.h"

namespace imunoise::report {

/// Text made safe for a terminal: no control characters, and ASCII where the style asks for it.
std::string terminal_text(std::string_view text, const TerminalStyle& style);

/// Words broken into lines no wider than the terminal, each after `indent` spaces.
std::string wrapped(std::string_view text, int indent, const TerminalStyle& style);

/// Rows of cells in aligned columns, which are as wide as their contents; where the terminal is too
/// narrow, cells continue below themselves, those of the widest columns first.
std::string terminal_table(const std::vector<std::string>& head,
                           const std::vector<std::vector<std::string>>& rows,
                           const TerminalStyle& style);

}  // namespace imunoise::report
