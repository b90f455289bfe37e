#pragma once

// Where the parts of a picture stand, in px, without drawing any of them.

#include <string>
#include <vector>

#include "study/figure/geometry.h"
#include "study/figure/scale.h"

namespace imunoise::figure {

/// Font sizes, in px.
constexpr double kTitleSize = 17.0;
constexpr double kTextSize = 12.0;
constexpr double kTickSize = 11.5;
constexpr double kNoteSize = 11.0;
constexpr double kCellSize = 10.0;

/// A panel below this height, in px, has smaller points and closer labels.
constexpr double kLowPanel = 130.0;

/// A figure below this width is for phones: one panel beside another has no room.
constexpr double kNarrow = 600.0;

/// A picture to be made.
struct Paper {
  double width = 900.0;    ///< px
  double height = 0.0;     ///< px; 0: as high as its panels ask for
  bool standalone = true;  ///< with title and caption, which a page writes itself
  bool narrow() const { return width < kNarrow; }
};

/// A text and its baseline.
struct PlacedText {
  std::string text;
  Point at;
};

struct PanelPlace {
  const Panel* panel = nullptr;
  Box frame;
  Box stack;  ///< this frame and those below that share its x-axis
  Scale x;
  Scale y;
  std::vector<Tick> y_ticks;
  std::vector<Tick> x_ticks;
  bool names_x = true;  ///< labels stand below this panel
  double title_baseline = 0.0;
  double axis_baseline = 0.0;       ///< of the titles of the y-axes
  std::vector<PlacedText> marks{};  ///< words of the marks, centred
  double left = 0.0;                ///< px, where the panel's own part of the picture begins
  double right = 0.0;               ///< px, and ends

  Point at(double across, double up) const;
};

struct KeyEntry {
  const Layer* layer = nullptr;
  Point at;  ///< left end of its sign; the baseline of its words
};

struct Layout {
  double width = 0.0;
  double height = 0.0;
  double frames = 0.0;  ///< px of the height that are frames of free height
  std::vector<KeyEntry> key{};
  std::vector<PanelPlace> panels{};
  std::vector<PlacedText> caption{};
};

Layout layout(const Figure& figure, const Paper& paper);

}  // namespace imunoise::figure
