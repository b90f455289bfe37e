#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "study/words/terminal_style.h"

namespace imunoise::figure {

/// A drawing in characters: curves in braille dots (2 × 4 a character; in ASCII one '.' a
/// character), and marks that cover them.
class TerminalCanvas {
 public:
  TerminalCanvas(int columns, int rows, const report::TerminalStyle& style);

  /// Size in dots; (0, 0) is the upper left.
  int dots_across() const { return columns_ * across_; }
  int dots_down() const { return rows_ * down_; }

  /// Points outside the canvas are passed over.
  void line(double x0, double y0, double x1, double y1, report::Ink ink = report::Ink::kModel,
            bool dashed = false);
  void mark(double x, double y, std::string_view character, report::Ink ink);

  /// One line of text a row, without line ends.
  std::vector<std::string> lines() const;

 private:
  struct Cell {
    unsigned dots = 0;
    std::string mark;
    report::Ink ink = report::Ink::kPlain;
  };
  Cell* cell_at(double x, double y);

  int columns_;
  int rows_;
  int across_;
  int down_;
  report::TerminalStyle style_;
  std::vector<Cell> cells_;
};

}  // namespace imunoise::figure
