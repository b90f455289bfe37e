#include "study/figure/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "study/words/text.h"

namespace imunoise::figure {
namespace {

constexpr char32_t kBraille = 0x2800;
constexpr int kDash = 2;  // dots

// Bit of the dot at (column, row) of a braille character, by Unicode's numbering.
constexpr std::array<std::array<unsigned, 4>, 2> kDots = {
    {{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}}};

}  // namespace

TerminalCanvas::TerminalCanvas(int columns, int rows, const report::TerminalStyle& style)
    : columns_(columns),
      rows_(rows),
      across_(style.unicode ? 2 : 1),
      down_(style.unicode ? 4 : 1),
      style_(style),
      cells_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

TerminalCanvas::Cell* TerminalCanvas::cell_at(double x, double y) {
  if (!(x >= 0.0 && x < dots_across() && y >= 0.0 && y < dots_down())) return nullptr;
  const int column = static_cast<int>(x) / across_;
  const int row = static_cast<int>(y) / down_;
  return &cells_[static_cast<std::size_t>(row * columns_ + column)];
}

void TerminalCanvas::line(double x0, double y0, double x1, double y1, report::Ink ink,
                          bool dashed) {
  const int steps = 1 + static_cast<int>(std::ceil(std::max(std::abs(x1 - x0), std::abs(y1 - y0))));
  for (int s = 0; s <= steps; ++s) {
    if (dashed && s % (2 * kDash) >= kDash) continue;
    const double t = static_cast<double>(s) / steps;
    const double x = x0 + t * (x1 - x0);
    const double y = y0 + t * (y1 - y0);
    if (Cell* const cell = cell_at(x, y)) {
      cell->dots |= kDots[static_cast<std::size_t>(static_cast<int>(x) % across_)]
                         [static_cast<std::size_t>(static_cast<int>(y) % down_)];
      cell->ink = ink;
    }
  }
}

void TerminalCanvas::mark(double x, double y, std::string_view character, report::Ink ink) {
  if (Cell* const cell = cell_at(x, y)) {
    cell->mark = character;
    cell->ink = ink;
  }
}

std::vector<std::string> TerminalCanvas::lines() const {
  std::vector<std::string> out;
  for (int row = 0; row < rows_; ++row) {
    std::string line;
    for (int column = 0; column < columns_; ++column) {
      const Cell& cell = cells_[static_cast<std::size_t>(row * columns_ + column)];
      if (!cell.mark.empty()) {
        line += report::inked(cell.mark, cell.ink, style_);
      } else if (cell.dots == 0) {
        line += ' ';
      } else if (style_.unicode) {
        std::string braille;
        report::append_utf8(braille, kBraille + cell.dots);
        line += report::inked(braille, cell.ink, style_);
      } else {
        line += report::inked(".", cell.ink, style_);
      }
    }
    out.push_back(std::move(line));
  }
  return out;
}

}  // namespace imunoise::figure
