#include "study/figure/layout.h"

#include <algorithm>
#include <cmath>

#include "study/figure/range.h"

namespace imunoise::figure {
namespace {

constexpr double kEdge = 4.0;        // px that texts keep from the picture's edge
constexpr double kMinorGap = 14.0;   // px from 1 to 2 where minor ticks do not crowd
constexpr double kKeySign = 24.0;    // px of a sign in the key
constexpr double kKeyGap = 14.0;     // px between entries
constexpr double kRow = 26.0;        // px, of a row with a name
constexpr double kMostRows = 400.0;  // px, of all rows together, as long as they are not lower than
constexpr double kLeastRow = 16.0;   // px, with a name each
constexpr double kLeastCell = 2.0;   // px, where colours are compared
constexpr double kMostName = 0.4;    // of the width, for the names of rows
constexpr double kMarkRow = 14.0;    // px
constexpr double kMarkGap = 4.0;     // px beside the words of a mark
constexpr std::size_t kMostMarkRows = 3;
constexpr double kLeastFrame = 40.0;  // px

bool has_rows(const Panel& panel) {
  return panel.y.kind == AxisKind::kCategories && !panel.y.categories.empty();
}

// px a label needs along an x-axis.
double label_width(const Axis& axis) {
  if (axis.kind == AxisKind::kTime) return 130.0;
  if (axis.kind == AxisKind::kLogarithmic || axis.kind == AxisKind::kSigma) return 42.0;
  double widest = axis.kind == AxisKind::kCategories ? 0.0 : 66.0;
  for (const std::string& name : axis.categories)
    widest = std::max(widest, text_width(name, kTickSize));
  return widest + 6.0;
}

// px a label needs along a y-axis of such a height.
double label_height(const Axis& axis, double height) {
  if (axis.kind == AxisKind::kLogarithmic) return 20.0;
  if (axis.kind == AxisKind::kSigma) return kTickSize + 1.0;
  if (axis.kind == AxisKind::kCategories) return kTickSize + 1.0;
  return height < kLowPanel ? 22.0 : 40.0;
}

double frame_height(const Panel& panel, bool narrow, double stretch) {
  if (has_rows(panel)) {
    const auto rows = static_cast<double>(panel.y.categories.size());
    const bool cells = std::any_of(panel.layers.begin(), panel.layers.end(),
                                   [](const Layer& one) { return one.shape == Shape::kCells; });
    return rows * std::clamp(kMostRows / rows, cells ? kLeastCell : kLeastRow, kRow);
  }
  const double own =
      narrow ? std::min(panel.height, std::max(0.75 * panel.height, 96.0)) : panel.height;
  return std::max(kLeastFrame, own * stretch);
}

double widest(const std::vector<Tick>& ticks) {
  double out = 0.0;
  for (const Tick& tick : ticks) {
    if (tick.major) out = std::max(out, text_width(label_text(tick), kTickSize));
  }
  return out;
}

struct Sides {
  double left = 0.0;
  double right = 0.0;
};

// What stands beside a frame of such a height.
Sides sides_of(const Panel& panel, double height, double width) {
  const Scale y = y_scale(panel);
  Sides out{widest(y.ticks(height, label_height(panel.y, height), kMinorGap)) + 14.0, 24.0};
  if (has_rows(panel)) out.left = std::min(out.left, kMostName * width);
  if (panel.right) {
    const Scale right = y.relabelled(panel.right->factor, panel.right->exponent);
    out.right = widest(right.ticks(height, label_height(panel.y, height), kMinorGap)) + 16.0;
  }
  return out;
}

struct MarkWords {
  std::string text;
  double x = 0.0;  // px, of its middle
  std::size_t row = 0;
};

// The words of marks in rows, the lowest first; those without room are left out.
std::vector<MarkWords> mark_words(const Panel& panel, const Scale& x, const Box& columns) {
  std::vector<MarkWords> out;
  const auto taken = [&](double left, double right, std::size_t row) {
    return std::any_of(out.begin(), out.end(), [&](const MarkWords& other) {
      const double half = 0.5 * text_width(other.text, kNoteSize) + kMarkGap;
      return other.row == row && other.x - half < right && left < other.x + half;
    });
  };
  for (const Layer& layer : panel.layers) {
    if (layer.shape != Shape::kMarks) continue;
    for (const Datum& one : layer.data) {
      if (one.words.empty() || !has_place(x.kind(), one.x) || !x.holds(one.x)) continue;
      const std::string text = fitted(one.words, kNoteSize, 0.5 * columns.width());
      const double half = 0.5 * text_width(text, kNoteSize);
      const double at = std::clamp(columns.left + x(one.x) * columns.width(), columns.left + half,
                                   columns.right - half);
      std::size_t row = 0;
      while (row < kMostMarkRows && taken(at - half, at + half, row)) ++row;
      if (row < kMostMarkRows) out.push_back({text, at, row});
    }
  }
  return out;
}

// px below a frame that names its x-axis.
double foot(const Axis& x) { return x.title.empty() ? 28.0 : 46.0; }

class Arranger {
 public:
  Arranger(const Figure& figure, const Paper& paper, double stretch)
      : figure_(figure), paper_(paper), stretch_(stretch) {}

  Layout arrange() {
    out_.width = paper_.width;
    double top = paper_.standalone && !figure_.title.empty() ? 30.0 : 0.0;
    if (paper_.standalone && !figure_.subtitle.empty()) top = 52.0;
    top = place_key(top);
    const std::vector<Stack> all = stacks(figure_.panels);
    const std::size_t columns =
        paper_.narrow()
            ? 1
            : std::clamp<std::size_t>(figure_.columns, 1, std::max<std::size_t>(1, all.size()));
    for (std::size_t first = 0; first < all.size(); first += columns) {
      double bottom = top;
      for (std::size_t c = 0; c < columns && first + c < all.size(); ++c) {
        const double step = paper_.width / static_cast<double>(columns);
        const double left = step * static_cast<double>(c);
        bottom = std::max(bottom, place_stack(all[first + c], left, left + step, top));
      }
      top = bottom;
    }
    out_.height = place_caption(top) + 2.0;
    return std::move(out_);
  }

 private:
  double place_key(double top) {
    Point at{kEdge, top + 18.0};
    std::vector<std::string> said;
    for (const Panel& panel : figure_.panels) {
      // What lies on top is said first.
      for (auto at_layer = panel.layers.rbegin(); at_layer != panel.layers.rend(); ++at_layer) {
        const Layer& layer = *at_layer;
        if (layer.key.empty() || layer.data.empty()) continue;
        if (std::find(said.begin(), said.end(), layer.key) != said.end()) continue;
        said.push_back(layer.key);
        const double width = kKeySign + text_width(layer.key, kTextSize);
        if (at.x > kEdge && at.x + width > paper_.width - kEdge) at = {kEdge, at.y + 20.0};
        out_.key.push_back({&layer, at});
        at.x += width + kKeyGap;
      }
    }
    return out_.key.empty() ? top : at.y + 8.0;
  }

  double place_stack(const Stack& stack, double left, double right, double top) {
    Sides sides;
    for (std::size_t i = stack.first; i < stack.end; ++i) {
      const Panel& panel = figure_.panels[i];
      const Sides own =
          sides_of(panel, frame_height(panel, paper_.narrow(), stretch_), right - left);
      sides = {std::max(sides.left, own.left), std::max(sides.right, own.right)};
    }
    const Scale x = x_scale(figure_.panels, stack);
    const std::size_t first_place = out_.panels.size();
    for (std::size_t i = stack.first; i < stack.end; ++i) {
      const Panel& panel = figure_.panels[i];
      PanelPlace place{&panel, {}, {}, x, y_scale(panel), {}, {}};
      place.left = left;
      place.right = right;
      place.frame = {left + sides.left, 0.0, right - sides.right, 0.0};
      top = place_panel(place, top);
      place.names_x = i + 1 == stack.end;
      top += place.names_x ? foot(figure_.panels[stack.first].x) : 14.0;
      out_.panels.push_back(std::move(place));
    }
    for (std::size_t k = first_place; k < out_.panels.size(); ++k) {
      out_.panels[k].stack = out_.panels[k].frame;
      out_.panels[k].stack.bottom = out_.panels.back().frame.bottom;
    }
    return top;
  }

  // Head and frame; says where the frame ends.
  double place_panel(PanelPlace& place, double top) {
    const Panel& panel = *place.panel;
    top += 4.0;
    if (!panel.title.empty() || !panel.note.empty()) {
      place.title_baseline = top + 13.0;
      top += 18.0;
    }
    if (!panel.y.title.empty() || panel.right) {
      place.axis_baseline = top + 13.0;
      top += 26.0;
    }
    const std::vector<MarkWords> marks = mark_words(panel, place.x, place.frame);
    std::size_t rows = 0;
    for (const MarkWords& one : marks) rows = std::max(rows, one.row + 1);
    top += kMarkRow * static_cast<double>(rows) + 4.0;
    for (const MarkWords& one : marks)
      place.marks.push_back(
          {one.text, {one.x, top - 7.0 - kMarkRow * static_cast<double>(one.row)}});
    const double height = frame_height(panel, paper_.narrow(), stretch_);
    if (!has_rows(panel)) out_.frames += height;
    place.frame.top = top;
    place.frame.bottom = top + height;
    place.y_ticks = place.y.ticks(height, label_height(panel.y, height), kMinorGap);
    place.x_ticks = place.x.ticks(place.frame.width(), label_width(axis_of_x(place)), kMinorGap);
    return place.frame.bottom;
  }

  // The x-axis of a panel that shares one is that of the first of them.
  const Axis& axis_of_x(const PanelPlace& place) const {
    const Panel* first = place.panel;
    while (first->shares_x && first != figure_.panels.data()) --first;
    return first->x;
  }

  double place_caption(double top) {
    if (!paper_.standalone) return top;
    const double line = 1.5 * kNoteSize;
    for (std::string& words : wrap_px(figure_.caption, kNoteSize, paper_.width - 2.0 * kEdge)) {
      top += line;
      out_.caption.push_back({std::move(words), {kEdge, top - 2.0}});
    }
    return out_.caption.empty() ? top : top + 4.0;
  }

  const Figure& figure_;
  const Paper& paper_;
  double stretch_;
  Layout out_;
};

}  // namespace

Point PanelPlace::at(double across, double up) const {
  return {frame.left + x(across) * frame.width(), y.kind() == AxisKind::kCategories
                                                      ? frame.top + y(up) * frame.height()
                                                      : frame.bottom - y(up) * frame.height()};
}

Layout layout(const Figure& figure, const Paper& paper) {
  Layout natural = Arranger(figure, paper, 1.0).arrange();
  if (!(paper.height > 0.0) || natural.frames == 0.0) return natural;
  const double stretch = 1.0 + (paper.height - natural.height) / natural.frames;
  return Arranger(figure, paper, std::max(0.0, stretch)).arrange();
}

}  // namespace imunoise::figure
