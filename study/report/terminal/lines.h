#pragma once

#include <string>

#include "study/words/terminal_style.h"

namespace imunoise::report {

/// The style, no narrower than anything can be read in.
TerminalStyle usable(TerminalStyle style);

/// One strong line, cut to the width.
std::string title_line(const std::string& text, const TerminalStyle& style);

/// A wrapped paragraph in one colour, line by line so that no colour runs over a line's end.
std::string paragraph(const std::string& text, Ink ink, const TerminalStyle& style);

}  // namespace imunoise::report
