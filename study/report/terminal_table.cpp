#include "study/report/terminal_table.h"

#include <algorithm>
#include <numeric>

#include "study/report/text.h"

namespace imunoise::report {
namespace {

constexpr std::size_t kGap = 2;          // spaces between columns
constexpr std::size_t kLeastLast = 16;   // columns that the last column keeps beside the others
constexpr std::size_t kLeastColumn = 4;  // columns below which no cell is cut

std::string padded(const std::string& text, std::size_t columns) {
  return text + std::string(columns - std::min(columns, display_width(text)), ' ');
}

// Takes from the widest column until the sum fits.
void shrink(std::vector<std::size_t>& widths, std::size_t room) {
  const auto total = [&] { return std::accumulate(widths.begin(), widths.end(), std::size_t{0}); };
  while (!widths.empty() && total() > room) {
    const auto widest = std::max_element(widths.begin(), widths.end());
    if (*widest <= kLeastColumn) return;
    --*widest;
  }
}

}  // namespace

std::string terminal_text(std::string_view text, const TerminalStyle& style) {
  const std::string clean = clean_text(text);
  return style.unicode ? clean : to_ascii(clean);
}

std::string wrapped(std::string_view text, int indent, const TerminalStyle& style) {
  const std::string margin(static_cast<std::size_t>(indent), ' ');
  const std::size_t room = static_cast<std::size_t>(std::max(10, style.width - indent));
  const std::string clean = terminal_text(text, style);
  std::string_view rest = clean;
  std::string out;
  std::string line;
  const auto end_line = [&] {
    if (!line.empty()) out += margin + line + "\n";
    line.clear();
  };
  while (!rest.empty()) {
    const auto space = rest.find(' ');
    std::string word(rest.substr(0, space));
    rest.remove_prefix(space == std::string_view::npos ? rest.size() : space + 1);
    if (word.empty()) continue;
    if (!line.empty() && display_width(line) + 1 + display_width(word) > room) end_line();
    // A word longer than a line is cut into lines.
    while (display_width(word) > room) {
      const std::string piece = shorten(word, room, "");
      out += margin + piece + "\n";
      word.erase(0, piece.size());
    }
    line += (line.empty() ? "" : " ") + word;
  }
  end_line();
  return out;
}

std::string terminal_table(const std::vector<std::string>& head,
                           const std::vector<std::vector<std::string>>& rows,
                           const TerminalStyle& style) {
  const std::string_view ellipsis = style.unicode ? "…" : "~";
  const std::size_t last = head.size() - 1;
  std::vector<std::vector<std::string>> cells = {head};
  cells.insert(cells.end(), rows.begin(), rows.end());
  std::vector<std::size_t> widths(head.size(), 0);
  for (auto& row : cells) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      row[c] = terminal_text(row[c], style);
      widths[c] = std::max(widths[c], display_width(row[c]));
    }
  }
  const auto width = static_cast<std::size_t>(style.width);
  const std::size_t indent = 2;
  const std::size_t gaps = indent + kGap * last;
  std::vector<std::size_t> others(widths.begin(), widths.end() - 1);
  shrink(others, width - gaps - std::min(widths[last], kLeastLast));
  const std::size_t used = std::accumulate(others.begin(), others.end(), gaps);

  std::string out;
  for (std::size_t r = 0; r < cells.size(); ++r) {
    std::string line(indent, ' ');
    for (std::size_t c = 0; c < last; ++c) {
      line += padded(shorten(cells[r][c], others[c], ellipsis), others[c]) + std::string(kGap, ' ');
    }
    // The last cell goes on below itself.
    const std::string tail = wrapped(cells[r][last], static_cast<int>(used), style);
    line += tail.empty() ? "\n" : tail.substr(used);
    if (tail.empty()) line.erase(line.find_last_not_of(" \n") + 1).append("\n");
    out += r == 0 ? inked(line.substr(0, line.size() - 1), Ink::kQuiet, style) + "\n" : line;
  }
  return out;
}

}  // namespace imunoise::report
