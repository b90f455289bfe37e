#pragma once

#include <string>
#include <string_view>

namespace imunoise::report {

/// How a terminal may be written to.
struct TerminalStyle {
  int width = 80;       ///< Columns; no line is longer. At least 40 are assumed.
  bool colour = false;  ///< ANSI colours.
  bool unicode = true;  ///< Else ASCII only.
};

enum class Ink { kPlain, kModel, kMeasured, kAlarm, kQuiet, kGood, kStrong };

/// `text` in a colour, if the style has any.
std::string inked(std::string_view text, Ink ink, const TerminalStyle& style);

/// Text made safe for a terminal: no control characters, and ASCII where the style asks for it.
std::string terminal_text(std::string_view text, const TerminalStyle& style);

}  // namespace imunoise::report
