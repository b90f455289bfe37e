#include "study/report/curve_chart.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "study/report/axis.h"
#include "study/report/budget_layout.h"
#include "study/report/svg_writer.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr double kLeft = 62.0;   // px, for the labels of the vertical axis
constexpr double kRight = 24.0;  // px, for half of the last label
constexpr double kTop = 46.0;    // px, for the title of the vertical axis and the marks
constexpr double kFoot = 48.0;   // px, for the horizontal axis
constexpr double kRadius = 3.2;  // px

struct Range {
  double low = INFINITY;
  double high = -INFINITY;
  void include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool spans() const { return low < high; }
};

class Plot {
 public:
  Plot(const CurveChart& chart, Range x, Range y, double width, double top)
      : chart_(chart),
        frame_{kLeft, top, width - kRight, top + (width < kNarrow ? 220.0 : 300.0)},
        x_(x.low / 1.15, x.high * 1.15, frame_.left, frame_.right),
        log_y_(chart.log_y ? y.low / 1.4 : 1.0, chart.log_y ? y.high * 1.4 : 10.0, frame_.bottom,
               frame_.top),
        y_(y.low - 0.06 * (y.high - y.low), y.high + 0.06 * (y.high - y.low), frame_.bottom,
           frame_.top) {}

  double bottom() const { return frame_.bottom + kFoot; }

  void draw(SvgWriter& svg) const {
    draw_axes(svg);
    if (chart_.reference)
      svg.line("axis", {frame_.left, height(*chart_.reference)},
               {frame_.right, height(*chart_.reference)});
    for (const CurveMark& mark : chart_.marks) {
      if (!x_.holds(mark.x)) continue;
      svg.line("stem outside", {x_(mark.x), frame_.top - 4.0}, {x_(mark.x), frame_.top + 10.0});
      svg.text("note", {x_(mark.x), frame_.top - 8.0}, clean_text(mark.text), kNoteSize,
               x_(mark.x) > 0.7 * frame_.right ? Anchor::kEnd : Anchor::kMiddle);
    }
    for (const Layer& layer : chart_.layers) draw_layer(svg, layer);
  }

 private:
  double height(double value) const {
    return std::clamp(chart_.log_y ? log_y_(value) : y_(value), frame_.top, frame_.bottom);
  }
  bool holds(const LayerPoint& one) const {
    return std::isfinite(one.x) && x_.holds(one.x) && std::isfinite(one.y) &&
           (!chart_.log_y || one.y > 0.0);
  }

  void draw_axes(SvgWriter& svg) const {
    for (const Tick& tick : x_.decade_ticks(54.0)) {
      svg.line(tick.major ? "grid" : "grid minor", {x_(tick.value), frame_.top},
               {x_(tick.value), frame_.bottom});
      if (tick.major)
        svg.text("tick", {x_(tick.value), frame_.bottom + 18.0}, tick_label(tick.value), kTickSize,
                 Anchor::kMiddle);
    }
    const auto level = [&](double value, const std::string& label) {
      svg.line("grid", {frame_.left, height(value)}, {frame_.right, height(value)});
      if (!label.empty())
        svg.text("tick", {frame_.left - 8.0, height(value) + 4.0}, label, kTickSize, Anchor::kEnd);
    };
    if (chart_.log_y) {
      for (const Tick& tick : log_y_.decade_ticks(26.0)) {
        if (!tick.major) continue;
        level(tick.value, "");
        svg.power_of_ten("tick", {frame_.left - 8.0, height(tick.value) + 4.0},
                         static_cast<int>(std::lround(std::log10(tick.value))), kTickSize,
                         Anchor::kEnd);
      }
    } else {
      for (const double value : y_.ticks(40.0)) level(value, tick_label(value));
    }
    svg.text("axis-title", {4.0, frame_.top - 26.0}, chart_.y_title, kTextSize, Anchor::kStart);
    svg.text("axis-title", {0.5 * (frame_.left + frame_.right), frame_.bottom + 38.0},
             chart_.x_title, kTextSize, Anchor::kMiddle);
  }

  void draw_layer(SvgWriter& svg, const Layer& layer) const {
    std::vector<Point> path;
    for (const LayerPoint& one : layer.points) {
      if (!holds(one)) continue;
      const Point at{x_(one.x), height(one.y)};
      if (layer.shape == LayerShape::kDots) {
        svg.circle(layer.css_class + (one.outside ? " outside" : ""), at, kRadius);
      } else {
        path.push_back(at);
      }
    }
    if (layer.shape == LayerShape::kBand) {
      for (auto one = layer.points.rbegin(); one != layer.points.rend(); ++one)
        if (holds(*one)) path.push_back({x_(one->x), height(one->upper)});
    }
    if (!path.empty()) svg.path(layer.css_class, path, layer.shape == LayerShape::kBand);
  }

  const CurveChart& chart_;
  Box frame_;
  LogAxis x_;
  LogAxis log_y_;
  LinearAxis y_;
};

}  // namespace

std::string curve_svg(const CurveChart& chart, const SvgOptions& options) {
  Range x;
  Range y;
  const auto place = [&](double value) {
    if (!chart.log_y || value > 0.0) y.include(value);
  };
  for (const Layer& layer : chart.layers) {
    for (const LayerPoint& one : layer.points) {
      if (!(one.x > 0.0)) continue;
      x.include(one.x);
      place(one.y);
      if (layer.shape == LayerShape::kBand) place(one.upper);
    }
  }
  if (chart.reference) place(*chart.reference);
  if (!x.spans() || !y.spans()) return "";
  const bool paper = options.variant == SvgVariant::kStandalone;
  const auto caption =
      paper ? wrap_px(chart.caption, kNoteSize, options.width - 8.0) : std::vector<std::string>{};
  const Plot plot(chart, x, y, options.width, kTop + (paper ? 34.0 : 0.0));
  const double line = 1.5 * kNoteSize;
  SvgWriter svg;
  svg.raw(svg_opening(options, plot.bottom() + line * static_cast<double>(caption.size()),
                      clean_text(chart.title)));
  if (paper) svg.text("title", {4.0, 22.0}, chart.title, kTitleSize, Anchor::kStart);
  plot.draw(svg);
  for (std::size_t i = 0; i < caption.size(); ++i) {
    svg.text("note", {4.0, plot.bottom() + line * (static_cast<double>(i) + 0.5)}, caption[i],
             kNoteSize, Anchor::kStart);
  }
  svg.close("svg");
  return svg.str();
}

std::optional<Figure> curve_figure(const CurveChart& chart) {
  const auto drawn = [&](double width, const char* kind) {
    return of_kind(curve_svg(chart, {SvgVariant::kInline, width, kind}), kind);
  };
  const std::string wide = drawn(920.0, "wide");
  if (wide.empty()) return std::nullopt;
  return Figure{chart.title, wide, drawn(388.0, "narrow"), chart.caption};
}

}  // namespace imunoise::report
