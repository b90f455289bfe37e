#pragma once

// A figure as plain data: panels, their axes, and layers of numbers in them. svg.h turns it into a
// picture, characters.h into lines of a terminal; neither knows what the numbers mean.

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace imunoise::figure {

/// A number that is not known. An interval's unknown end runs to the edge of the panel.
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Styles that there are for the parts of a model: .term-0 to .term-5 of plot.css.
constexpr std::size_t kTermStyles = 6;

enum class AxisKind {
  kLinear,
  kLogarithmic,  ///< zeros and negative values have no place
  kSigma,        ///< standard deviations: nearly linear within ±2, logarithmic beyond
  kTime,         ///< seconds since 1970-01-01 UTC
  kDuration,     ///< seconds since something began
  kCategories,   ///< the value k stands for the k-th name, from the top down or from the left
};

struct Axis {
  AxisKind kind = AxisKind::kLinear;
  std::string title{};
  std::string short_title{};              ///< for narrow pictures; empty: the title
  std::vector<std::string> categories{};  ///< names of kCategories
  std::optional<double> low{};            ///< a fixed end; else the layers decide
  std::optional<double> high{};
};

/// A second labelling of the y-axis, on the right: factor · yᵉˣᵖᵒⁿᵉⁿᵗ. For logarithmic axes.
struct RightAxis {
  std::string title{};
  std::string short_title{};
  double factor = 1.0;
  double exponent = 1.0;
};

/// How a layer's numbers are drawn.
enum class Shape {
  kLine,       ///< (x, y) joined; what has no place interrupts nothing
  kPoints,     ///< circles at (x, y), with whiskers from lower to upper where one of them is known
  kBand,       ///< the area from lower to upper over x
  kIntervals,  ///< in row y: a dot at x, and a line from lower to upper along x
  kBars,       ///< from zero, or the axis's edge, to the value; a thin one ends in a dot
  kMarks,      ///< places on x that are pointed at, with words
  kCells,      ///< in row y, x from lower to upper: a colour by sigma, and words
  kColumns,    ///< x from lower to upper, through this panel and those below that share its x-axis
  kRows,       ///< y from lower to upper over the whole width
};

/// What a layer means: its colour in a picture and in a terminal.
enum class Role {
  kMeasured,
  kModel,
  kTerm,       ///< one part of a model
  kGhost,      ///< a model that might be, beside the one that is
  kReplicate,  ///< one of many measurements
  kInterval,   ///< where a measurement may lie
  kChance,     ///< what chance alone does
  kMisfit,     ///< where a model fails
  kUntested,   ///< what no test looks at
};

enum class State {
  kPlain,
  kOutside,   ///< deviates by more than chance
  kUntested,  ///< means less than the others
};

/// One place of a layer; which fields count depends on the layer's shape.
struct Datum {
  double x = kUnknown;
  double y = kUnknown;
  double lower = kUnknown;
  double upper = kUnknown;
  State state = State::kPlain;
  double sigma = kUnknown;  ///< deviation from what is expected, in standard deviations
  std::string words{};
};

struct Layer {
  Shape shape = Shape::kLine;
  Role role = Role::kModel;
  std::string name{};     ///< what a page calls it by: "AR1 (2)"
  std::size_t style = 0;  ///< which of the styles of kTerm
  bool labelled = false;  ///< the name is written along the line
  bool widens = true;     ///< the axes make room for it
  std::string key{};      ///< what the key says; equal words are said once
  std::vector<Datum> data{};
};

struct Panel {
  std::string title{};  ///< above it, on the left
  std::string note{};   ///< above it, on the right
  Axis x{};
  Axis y{};
  std::optional<RightAxis> right{};
  bool shares_x = false;  ///< stands below the panel before it, on the same x-axis
  double height = 300.0;  ///< px in a wide picture; rows of categories have a height of their own
  std::optional<double> x_reference{};  ///< a line across at this x
  std::optional<double> y_reference{};  ///< a line across at this y
  std::vector<Layer> layers{};
};

struct Figure {
  std::string title{};
  std::string subtitle{};
  std::string caption{};
  std::string sentence{};  ///< for those who cannot see it; empty: the title
  std::vector<Panel> panels{};
  std::size_t columns = 1;  ///< panels side by side, where there is room
  bool cursor = false;      ///< a page's pointer reads the first points, place by place
};

/// The same figure where a number has a place in it; nothing where all would be empty.
std::optional<Figure> unless_empty(Figure figure);

}  // namespace imunoise::figure
