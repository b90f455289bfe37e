#include "study/figure/characters.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "study/figure/canvas.h"
#include "study/figure/character_rows.h"
#include "study/figure/range.h"
#include "study/words/text.h"

namespace imunoise::figure {
namespace {

constexpr double kHighPanel = 200.0;  // px
constexpr int kHighRows = 14;
constexpr int kLowRows = 7;
constexpr int kLeastMargin = 9;       // columns left of the axis
constexpr double kMostMargin = 0.35;  // of the width
constexpr double kRowLabel = 2.0;     // rows that a label of the y-axis needs

using report::Ink;
using report::TerminalStyle;

int rows_of(const Panel& panel) {
  if (panel.y.kind == AxisKind::kCategories && !panel.y.categories.empty())
    return static_cast<int>(panel.y.categories.size());
  return panel.height >= kHighPanel ? kHighRows : kLowRows;
}

Ink ink_of(const Layer& layer, State state) {
  if (state == State::kOutside) return Ink::kAlarm;
  if (state == State::kUntested) return Ink::kQuiet;
  return layer.role == Role::kModel ? Ink::kModel : Ink::kMeasured;
}

// A panel of curves and points.
class Drawing {
 public:
  Drawing(const Panel& panel, const Scale& x, int columns, const TerminalStyle& style)
      : x_(x),
        y_(y_scale(panel)),
        rows_(rows_of(panel)),
        style_(style),
        canvas_(columns, rows_, style) {
    for (const Layer& layer : panel.layers) {
      if (layer.shape == Shape::kLine) draw_line(layer);
      if (layer.shape == Shape::kBand && layer.role == Role::kMeasured) draw_trace(layer);
    }
    for (const Layer& layer : panel.layers) {
      if (layer.shape == Shape::kPoints) draw_points(layer);
      if (layer.shape == Shape::kBars) draw_bars(layer);
      if (layer.shape == Shape::kMarks) draw_marks(layer);
    }
  }

  std::vector<std::string> lines() const { return canvas_.lines(); }

  // Labels of the rows that ticks fall into.
  std::vector<std::string> row_labels() const {
    std::vector<std::string> out(static_cast<std::size_t>(rows_));
    for (const Tick& tick : y_.ticks(rows_, kRowLabel, rows_)) {
      const auto row =
          static_cast<std::size_t>(std::clamp((1.0 - y_(tick.value)) * rows_, 0.0, rows_ - 1.0));
      if (tick.major && out[row].empty()) out[row] = label_text(tick, style_.unicode);
    }
    return out;
  }

 private:
  bool has(double x, double y) const { return has_place(x_.kind(), x) && has_place(y_.kind(), y); }
  double across(double x) const { return x_(x) * canvas_.dots_across(); }
  double down(double y) const { return (1.0 - y_(y)) * canvas_.dots_down(); }

  void draw_line(const Layer& layer) {
    const Datum* previous = nullptr;
    for (const Datum& one : layer.data) {
      if (!has(one.x, one.y)) continue;
      if (previous != nullptr)
        canvas_.line(across(previous->x), down(previous->y), across(one.x), down(one.y),
                     layer.role == Role::kGhost ? Ink::kQuiet : Ink::kModel,
                     layer.role == Role::kGhost);
      previous = &one;
    }
  }
  void draw_trace(const Layer& layer) {
    for (const Datum& one : layer.data) {
      if (has(one.x, one.lower) && has(one.x, one.upper))
        canvas_.line(across(one.x), down(one.lower), across(one.x), down(one.upper));
    }
  }
  void draw_points(const Layer& layer) {
    for (const Datum& one : layer.data) {
      if (!has(one.x, one.y)) continue;
      const bool outside = one.state == State::kOutside;
      const char* const mark = style_.unicode ? (outside ? "◆" : "●") : (outside ? "x" : "o");
      canvas_.mark(across(one.x), down(one.y), mark, ink_of(layer, one.state));
    }
  }
  void draw_bars(const Layer& layer) {
    for (const Datum& one : layer.data) {
      if (!has(one.x, one.y)) continue;
      const double zero = has_place(y_.kind(), 0.0) ? down(0.0) : canvas_.dots_down();
      canvas_.line(across(one.x), zero, across(one.x), down(one.y));
      canvas_.mark(across(one.x), down(one.y), style_.unicode ? "●" : "o",
                   ink_of(layer, one.state));
    }
  }
  void draw_marks(const Layer& layer) {
    for (const Datum& one : layer.data) {
      if (has_place(x_.kind(), one.x))
        canvas_.mark(across(one.x), 0.0, style_.unicode ? "▼" : "v", Ink::kAlarm);
    }
  }

  Scale x_;
  Scale y_;
  int rows_;
  TerminalStyle style_;
  TerminalCanvas canvas_;
};

// The figure without what a terminal does not show, so that nothing else makes its axes long.
Figure for_terminal(Figure figure) {
  for (Panel& panel : figure.panels) {
    std::erase_if(panel.layers, [](const Layer& layer) {
      const bool band = layer.shape == Shape::kBand && layer.role != Role::kMeasured;
      const bool line = layer.shape == Shape::kLine &&
                        (layer.role == Role::kTerm || layer.role == Role::kReplicate);
      return band || line || layer.shape == Shape::kColumns || layer.shape == Shape::kRows;
    });
    for (Layer& layer : panel.layers) {
      if (layer.shape != Shape::kPoints) continue;
      for (Datum& one : layer.data) one.lower = one.upper = kUnknown;
    }
  }
  return figure;
}

bool is_strip(const Panel& panel) { return panel.y.kind == AxisKind::kSigma; }

class Sheet {
 public:
  Sheet(Figure figure, const TerminalStyle& style)
      : figure_(for_terminal(std::move(figure))), style_(style) {
    std::size_t widest = 0;
    for (const Panel& panel : figure_.panels) {
      for (const std::string& name : panel.y.categories)
        widest = std::max(widest, report::display_width(report::terminal_text(name, style)) + 2);
    }
    margin_ = std::max(kLeastMargin, std::min(static_cast<int>(widest),
                                              static_cast<int>(kMostMargin * style.width)));
    columns_ = style.width - margin_ - 1;
  }

  std::string text() {
    for (const Stack& stack : stacks(figure_.panels)) {
      const Scale x = x_scale(figure_.panels, stack);
      for (std::size_t i = stack.first; i < stack.end; ++i) {
        const Panel& panel = figure_.panels[i];
        if (!has_numbers(panel)) continue;
        add_title(panel);
        add_panel(panel, x);
        if (i == stack.first) add_x_axis(figure_.panels[stack.first].x, x);
      }
    }
    return std::move(out_);
  }

 private:
  void add_title(const Panel& panel) {
    std::string title = panel.title;
    if (is_strip(panel)) return;  // its rows are named
    if (!panel.y.title.empty()) title += (title.empty() ? "" : ": ") + panel.y.title;
    if (!title.empty()) add_line(report::inked(cut(title, style_.width), Ink::kQuiet, style_));
  }

  void add_panel(const Panel& panel, const Scale& x) {
    const char* const axis = style_.unicode ? "│" : "|";
    if (is_strip(panel)) {
      const std::string sigma = style_.unicode ? "σ" : "sd";
      for (const bool above : {true, false})
        add_row((above ? "+" : "-") + sigma, axis, digit_row(panel, x, columns_, above, style_));
      return;
    }
    if (panel.y.kind == AxisKind::kCategories && !panel.y.categories.empty()) {
      for (std::size_t row = 0; row < panel.y.categories.size(); ++row)
        add_row(panel.y.categories[row], axis, category_row(panel, x, row, columns_, style_));
      return;
    }
    const Drawing drawing(panel, x, columns_, style_);
    const std::vector<std::string> labels = drawing.row_labels();
    const std::vector<std::string> lines = drawing.lines();
    for (std::size_t r = 0; r < lines.size(); ++r) add_row(labels[r], axis, lines[r]);
  }

  void add_x_axis(const Axis& axis, const Scale& x) {
    std::string line;
    for (int c = 0; c < columns_; ++c) line += style_.unicode ? "─" : "-";
    add_row("", style_.unicode ? "└" : "+", line);
    add_line(std::string(static_cast<std::size_t>(margin_), ' ') + tick_row(x, columns_, style_));
    if (axis.title.empty()) return;
    const std::string title = cut(axis.title, columns_);
    const auto room = static_cast<std::size_t>(columns_) - report::display_width(title);
    add_line(std::string(static_cast<std::size_t>(margin_) + room / 2, ' ') +
             report::inked(title, Ink::kQuiet, style_));
  }

  std::string cut(const std::string& text, int columns) const {
    return report::shorten(report::terminal_text(text, style_), static_cast<std::size_t>(columns),
                           style_.unicode ? "…" : "~");
  }
  void add_row(const std::string& label, const char* axis, const std::string& content) {
    const std::string name = cut(label, margin_ - 2);
    const auto room = static_cast<std::size_t>(margin_ - 2);
    add_line(std::string(room - std::min(room, report::display_width(name)), ' ') + name + " " +
             axis + content);
  }
  void add_line(const std::string& line) { out_ += line + "\n"; }

  Figure figure_;
  TerminalStyle style_;
  int margin_ = kLeastMargin;
  int columns_ = 0;
  std::string out_;
};

}  // namespace

std::string characters(const Figure& figure, const TerminalStyle& style) {
  return Sheet(figure, style).text();
}

}  // namespace imunoise::figure
