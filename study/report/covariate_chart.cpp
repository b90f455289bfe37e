#include "study/report/covariate_chart.h"

#include <algorithm>
#include <cmath>

#include "study/report/axis.h"
#include "study/report/budget_layout.h"
#include "study/report/svg_plot.h"
#include "study/report/svg_writer.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr double kLeft = 66.0;         // px, for the labels of the vertical axis
constexpr double kRight = 24.0;        // px, for half of the last label
constexpr double kTop = 34.0;          // px, for the title of the vertical axis
constexpr double kFrame = 300.0;       // px, height of the frame
constexpr double kFoot = 52.0;         // px, for the horizontal axis
constexpr double kMostInterval = 1.6;  // of the largest value: longer intervals are cut

double known_upper(const ChartPoint& point) {
  return std::isfinite(point.upper) ? std::max(point.upper, point.value) : point.value;
}

std::vector<ChartPoint> drawable_points(std::vector<ChartPoint> points) {
  std::erase_if(points, [](const ChartPoint& point) {
    return !std::isfinite(point.covariate) || !std::isfinite(point.value) || point.value < 0.0;
  });
  return points;
}

// Labels of a few digits stay as they are; large and small ones get an exponent.
std::string label_of(double value) {
  const double size = std::abs(value);
  return size == 0.0 || (size >= 1e-3 && size < 1e5) ? tick_label(value)
                                                     : number(value, 2, Digits::kTypeset);
}

class Plot {
 public:
  Plot(const std::vector<ChartPoint>& curve, const std::vector<ChartPoint>& points, double width,
       double top)
      : frame_{kLeft, top, width - kRight, top + kFrame},
        across_(frame_of(curve, points, frame_.left, frame_.right)),
        up_(0.0, highest(curve, points), frame_.bottom, frame_.top) {}

  void draw_axes(SvgWriter& svg, const CovariateChart& chart) const {
    const auto columns =
        static_cast<std::size_t>((frame_.right - 8.0) / text_width("x", kTextSize));
    for (const double value : up_.ticks(44.0)) {
      svg.line("grid", {frame_.left, up_(value)}, {frame_.right, up_(value)});
      svg.text("tick", {frame_.left - 8.0, up_(value) + 4.0}, label_of(value), kTickSize,
               Anchor::kEnd);
    }
    for (const double value : across_.ticks(70.0)) {
      svg.line("axis", {across_(value), frame_.bottom}, {across_(value), frame_.bottom + 5.0});
      svg.text("tick", {across_(value), frame_.bottom + 20.0}, label_of(value), kTickSize,
               Anchor::kMiddle);
    }
    svg.line("axis", {frame_.left, frame_.bottom}, {frame_.right, frame_.bottom});
    svg.text("axis-title", {4.0, frame_.top - 14.0},
             shorten(clean_text(chart.value_title), columns), kTextSize, Anchor::kStart);
    svg.text("axis-title", {0.5 * (frame_.left + frame_.right), frame_.bottom + 40.0},
             shorten(clean_text(chart.covariate_title), columns), kTextSize, Anchor::kMiddle);
  }

  void draw_curve(SvgWriter& svg, const std::vector<ChartPoint>& curve) const {
    std::vector<Point> line;
    std::vector<Point> band;
    for (const ChartPoint& one : curve) {
      line.push_back({across_(one.covariate), height(one.value)});
      band.push_back(
          {across_(one.covariate), std::isfinite(one.upper) ? height(one.upper) : frame_.top});
    }
    for (auto one = curve.rbegin(); one != curve.rend(); ++one) {
      band.push_back({across_(one->covariate),
                      std::isfinite(one->lower) ? height(one->lower) : frame_.bottom});
    }
    svg.path("band", band, true);
    svg.path("model", line);
  }

  void draw_points(SvgWriter& svg, const std::vector<ChartPoint>& points) const {
    for (const ChartPoint& one : points) {
      const double x = across_(one.covariate);
      const bool bounded = !(one.lower > 0.0);  // only its upper end means something
      svg.line("whisker", {x, bounded ? frame_.bottom : height(one.lower)},
               {x, std::isfinite(one.upper) ? height(one.upper) : frame_.top});
      svg.circle(bounded ? "measured untested" : "measured", {x, height(one.value)}, 3.6);
    }
  }

 private:
  static LinearAxis frame_of(const std::vector<ChartPoint>& curve,
                             const std::vector<ChartPoint>& points, double left, double right) {
    double low = 1e300;
    double high = -1e300;
    for (const auto* all : {&curve, &points}) {
      for (const ChartPoint& one : *all) {
        low = std::min(low, one.covariate);
        high = std::max(high, one.covariate);
      }
    }
    const double margin = 0.03 * (high - low);
    return {low - margin, high + margin, left, right};
  }

  static double highest(const std::vector<ChartPoint>& curve,
                        const std::vector<ChartPoint>& points) {
    double value = 0.0;
    double upper = 0.0;
    for (const auto* all : {&curve, &points}) {
      for (const ChartPoint& one : *all) {
        value = std::max(value, one.value);
        upper = std::max(upper, known_upper(one));
      }
    }
    if (value > 0.0) upper = std::min(upper, kMostInterval * value);
    return upper > 0.0 ? 1.05 * upper : 1.0;
  }

  double height(double value) const { return std::max(frame_.top, up_(std::max(0.0, value))); }

  Box frame_;
  LinearAxis across_;
  LinearAxis up_;
};

std::string draw(const CovariateChart& chart, const SvgOptions& options) {
  const bool paper = options.variant == SvgVariant::kStandalone;
  const auto caption =
      paper ? wrap_px(chart.caption, kNoteSize, options.width - 8.0) : std::vector<std::string>{};
  const double top = kTop + (paper ? 34.0 : 0.0);
  const double bottom = top + kFrame + kFoot;
  const double line = 1.5 * kNoteSize;
  SvgWriter svg;
  std::string opening = svg_opening(options, bottom + line * static_cast<double>(caption.size()),
                                    clean_text(chart.title));
  svg.raw(paper ? opening : of_kind(std::move(opening), options.id));
  if (paper) svg.text("title", {4.0, 22.0}, chart.title, kTitleSize, Anchor::kStart);
  const Plot plot(chart.curve, chart.points, options.width, top);
  plot.draw_axes(svg, chart);
  plot.draw_curve(svg, chart.curve);
  plot.draw_points(svg, chart.points);
  for (std::size_t i = 0; i < caption.size(); ++i) {
    svg.text("note", {4.0, bottom + line * (static_cast<double>(i) + 0.5)}, caption[i], kNoteSize,
             Anchor::kStart);
  }
  svg.close("svg");
  return svg.str();
}

CovariateChart cleaned(CovariateChart chart) {
  chart.curve = drawable_points(std::move(chart.curve));
  chart.points = drawable_points(std::move(chart.points));
  return chart;
}

bool spans(const std::vector<ChartPoint>& curve) {
  return curve.size() >= 2 && curve.front().covariate < curve.back().covariate;
}

}  // namespace

std::optional<Figure> covariate_figure(const CovariateChart& wanted) {
  const CovariateChart chart = cleaned(wanted);
  if (!spans(chart.curve)) return std::nullopt;
  return Figure{chart.title, draw(chart, {SvgVariant::kInline, 920.0, "wide"}),
                draw(chart, {SvgVariant::kInline, 388.0, "narrow"}), chart.caption};
}

std::string covariate_svg(const CovariateChart& wanted) {
  const CovariateChart chart = cleaned(wanted);
  return spans(chart.curve) ? draw(chart, {}) : std::string();
}

}  // namespace imunoise::report
