#include "study/report/terminal/lines.h"

#include <algorithm>

#include "study/report/terminal/table.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr int kLeastWidth = 40;

}  // namespace

TerminalStyle usable(TerminalStyle style) {
  style.width = std::max(style.width, kLeastWidth);
  return style;
}

std::string title_line(const std::string& text, const TerminalStyle& style) {
  const std::string_view ellipsis = style.unicode ? "…" : "~";
  const std::string line =
      shorten(terminal_text(text, style), static_cast<std::size_t>(style.width), ellipsis);
  return inked(line, Ink::kStrong, style) + "\n";
}

std::string paragraph(const std::string& text, Ink ink, const TerminalStyle& style) {
  const std::string lines = wrapped(text, 0, style);
  std::string out;
  for (std::size_t at = 0; at < lines.size();) {
    const auto end = lines.find('\n', at);
    out += inked(std::string_view(lines).substr(at, end - at), ink, style) + "\n";
    at = end + 1;
  }
  return out;
}

}  // namespace imunoise::report
