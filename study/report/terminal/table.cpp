#include "study/report/terminal/table.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr std::size_t kIndent = 2;       // spaces before the first column
constexpr std::size_t kColumnGap = 2;    // spaces between columns
constexpr std::size_t kLeastLast = 16;   // columns that the last column keeps beside the others
constexpr std::size_t kLeastColumn = 4;  // columns below which no cell is broken

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

// The first part of a word longer than `room` columns: to the last mark after which names and terms
// are cut, "heavy_" of "heavy_tails(dof=9)", unless it would be short.
std::string first_part(const std::string& word, std::size_t room) {
  std::string out = shorten(word, room, "");
  const auto mark = out.find_last_of("_(,/=");
  if (mark != std::string::npos && 3 * mark > out.size()) out.resize(mark + 1);
  return out;
}

// Words in lines of at most `room` columns; a word longer than a line is cut into lines.
std::vector<std::string> broken(std::string_view text, std::size_t room) {
  std::vector<std::string> out;
  std::string line;
  const auto end_line = [&] {
    if (!line.empty()) out.push_back(std::move(line));
    line.clear();
  };
  while (!text.empty()) {
    const auto space = text.find(' ');
    std::string word(text.substr(0, space));
    text.remove_prefix(space == std::string_view::npos ? text.size() : space + 1);
    if (word.empty()) continue;
    if (!line.empty() && display_width(line) + 1 + display_width(word) > room) end_line();
    while (display_width(word) > room) {
      out.push_back(first_part(word, room));
      word.erase(0, out.back().size());
    }
    line += (line.empty() ? "" : " ") + word;
  }
  end_line();
  return out;
}

// One row of cells, each continued below itself where its column is too narrow.
std::string row_lines(const std::vector<std::string>& row, const std::vector<std::size_t>& widths,
                      Ink ink, const TerminalStyle& style) {
  std::vector<std::vector<std::string>> cells;
  std::size_t height = 1;
  for (std::size_t c = 0; c < row.size(); ++c) {
    cells.push_back(broken(row[c], widths[c]));
    height = std::max(height, cells.back().size());
  }
  std::string out;
  for (std::size_t h = 0; h < height; ++h) {
    std::string line;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      line += std::string(c == 0 ? kIndent : kColumnGap, ' ') +
              padded(h < cells[c].size() ? cells[c][h] : "", widths[c]);
    }
    out += inked(line.erase(line.find_last_not_of(' ') + 1), ink, style) + "\n";
  }
  return out;
}

}  // namespace

std::string wrapped(std::string_view text, int indent, const TerminalStyle& style) {
  const std::string margin(static_cast<std::size_t>(indent), ' ');
  const auto room = static_cast<std::size_t>(std::max(10, style.width - indent));
  std::string out;
  for (const std::string& line : broken(terminal_text(text, style), room)) {
    out += margin + line + "\n";
  }
  return out;
}

std::string terminal_table(const std::vector<std::string>& head,
                           const std::vector<std::vector<std::string>>& rows,
                           const TerminalStyle& style) {
  std::vector<std::vector<std::string>> cells = {head};
  cells.insert(cells.end(), rows.begin(), rows.end());
  std::vector<std::size_t> widths(head.size(), 0);
  for (auto& row : cells) {
    assert(row.size() <= head.size());
    for (std::size_t c = 0; c < row.size(); ++c) {
      row[c] = terminal_text(row[c], style);
      widths[c] = std::max(widths[c], display_width(row[c]));
    }
  }
  const std::size_t last = head.size() - 1;
  const std::size_t room = static_cast<std::size_t>(style.width) - kIndent - kColumnGap * last;
  std::vector<std::size_t> others(widths.begin(), widths.end() - 1);
  shrink(others, room - std::min(widths[last], kLeastLast));
  std::copy(others.begin(), others.end(), widths.begin());
  widths[last] = room - std::accumulate(others.begin(), others.end(), std::size_t{0});

  std::string out;
  for (std::size_t r = 0; r < cells.size(); ++r) {
    out += row_lines(cells[r], widths, r == 0 ? Ink::kQuiet : Ink::kPlain, style);
  }
  return out;
}

}  // namespace imunoise::report
