#pragma once

#include <string>
#include <string_view>
#include <vector>

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

/// A drawing in characters: curves in braille dots (2 × 4 a character; in ASCII one '.' a
/// character), and marks that cover them.
class TerminalCanvas {
 public:
  TerminalCanvas(int columns, int rows, const TerminalStyle& style);

  /// Size in dots; (0, 0) is the upper left.
  int dots_across() const { return columns_ * across_; }
  int dots_down() const { return rows_ * down_; }

  /// Points outside the canvas are passed over.
  void line(double x0, double y0, double x1, double y1);
  void mark(double x, double y, std::string_view character, Ink ink);

  /// One line of text a row, without line ends.
  std::vector<std::string> lines() const;

 private:
  struct Cell {
    unsigned dots = 0;
    std::string mark;
    Ink ink = Ink::kPlain;
  };
  Cell* cell_at(double x, double y);

  int columns_;
  int rows_;
  int across_;
  int down_;
  TerminalStyle style_;
  std::vector<Cell> cells_;
};

}  // namespace imunoise::report
