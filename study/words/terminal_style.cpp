#include "study/words/terminal_style.h"

#include "study/words/text.h"

namespace imunoise::report {
namespace {

std::string_view ansi(Ink ink) {
  switch (ink) {
    case Ink::kPlain:
      break;
    case Ink::kModel:
      return "\x1b[34m";
    case Ink::kMeasured:
      return "\x1b[1m";
    case Ink::kAlarm:
      return "\x1b[1;31m";
    case Ink::kQuiet:
      return "\x1b[2m";
    case Ink::kGood:
      return "\x1b[32m";
    case Ink::kStrong:
      return "\x1b[1m";
  }
  return {};
}

}  // namespace

std::string inked(std::string_view text, Ink ink, const TerminalStyle& style) {
  const std::string_view code = style.colour ? ansi(ink) : std::string_view{};
  if (code.empty()) return std::string(text);
  return std::string(code).append(text).append("\x1b[0m");
}

std::string terminal_text(std::string_view text, const TerminalStyle& style) {
  const std::string clean = clean_text(text);
  return style.unicode ? clean : to_ascii(clean);
}

}  // namespace imunoise::report
