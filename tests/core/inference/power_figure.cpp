#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/report/axis.h"
#include "study/report/budget_layout.h"
#include "study/report/svg_plot.h"
#include "study/report/svg_writer.h"
#include "tests/core/inference/power_curve.h"

namespace imunoise::testing {
namespace {

using report::Anchor;
using report::Box;
using report::LogAxis;
using report::Point;
using report::SvgWriter;

constexpr double kWidth = 900.0;      // px
constexpr double kTop = 116.0;        // px, of the frames
constexpr double kHeight = 220.0;     // px, of a frame
constexpr double kMargin = 46.0;      // px, left of a frame
constexpr double kNoSpread = 26.0;    // px from a frame's left edge to the place of "no spread"
constexpr double kSmallRadius = 2.6;  // px

// Frame and axes of one curve. A logarithmic axis has no zero: that stands by itself at the left.
class Panel {
 public:
  Panel(const PowerCurve& curve, const Box& frame)
      : frame_(frame),
        spread_(100.0 * curve.points[1].spread / 1.3, 100.0 * curve.points.back().spread * 1.3,
                frame.left + 2.0 * kNoSpread, frame.right) {}

  double x(double spread) const {
    return spread > 0.0 ? spread_(100.0 * spread) : frame_.left + kNoSpread;
  }
  double y(double share) const { return frame_.bottom + share * (frame_.top - frame_.bottom); }

  void draw_axes(SvgWriter& svg, const PowerCurve& curve) const {
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      svg.line("grid", {frame_.left, y(share)}, {frame_.right, y(share)});
      svg.text("tick", {frame_.left - 7.0, y(share) + 4.0}, fmt::format("{:.0f}", 100.0 * share),
               report::kTickSize, Anchor::kEnd);
    }
    for (const PowerPoint& point : curve.points) {
      svg.line("axis", {x(point.spread), frame_.bottom}, {x(point.spread), frame_.bottom + 5.0});
      svg.text("tick", {x(point.spread), frame_.bottom + 19.0},
               fmt::format("{:g}", 100.0 * point.spread), report::kTickSize, Anchor::kMiddle);
    }
    svg.line("axis", {frame_.left, frame_.bottom}, {frame_.right, frame_.bottom});
    svg.text("axis-title", {0.5 * (frame_.left + frame_.right), frame_.bottom + 38.0},
             fmt::format("spread of {}, %", curve.moves), report::kTextSize, Anchor::kMiddle);
  }

  void draw_share(SvgWriter& svg, const PowerCurve& curve, double PowerPoint::*share,
                  const char* css_class) const {
    std::vector<Point> line;
    for (const PowerPoint& point : curve.points) line.push_back({x(point.spread), y(point.*share)});
    svg.path(css_class, line);
  }

  // Measured shares, with 95 % of what chance does to them.
  void draw_marks(SvgWriter& svg, const PowerCurve& curve) const {
    for (const PowerPoint& point : curve.points) {
      const double p = point.heterogeneity;
      const double reach = 1.96 * std::sqrt(p * (1.0 - p) / static_cast<double>(curve.sets));
      const double at = x(point.spread);
      svg.line("whisker", {at, y(std::max(0.0, p - reach))}, {at, y(std::min(1.0, p + reach))});
      svg.circle("measured", {at, y(p)}, kSmallRadius);
    }
  }

 private:
  Box frame_;
  LogAxis spread_;
};

void draw_key(SvgWriter& svg, double baseline) {
  double left = 4.0;
  const auto words = [&](const char* text) {
    svg.text("key", {left + 26.0, baseline}, text, report::kTextSize, Anchor::kStart);
    left += 26.0 + report::text_width(text, report::kTextSize) + 10.0;
  };
  const double y = baseline - 4.0;
  svg.line("whisker", {left + 10.0, y - 7.0}, {left + 10.0, y + 7.0});
  svg.circle("measured", {left + 10.0, y}, kSmallRadius);
  words("heterogeneity, measured");
  for (const auto& [css_class, text] :
       {std::pair("model", "heterogeneity, theory"),
        std::pair("term term-1", "published statistic"), std::pair("term term-0", "misfit")}) {
    svg.path(css_class, {{left, y}, {left + 20.0, y}});
    words(text);
  }
}

}  // namespace

std::string power_figure(const std::vector<PowerCurve>& curves) {
  SvgWriter svg;
  svg.raw(report::svg_opening({report::SvgVariant::kStandalone, kWidth, "power"},
                              kTop + kHeight + 50.0, "Power of the tests of near-stationarity"));
  svg.text("title", {4.0, 22.0}, "How often each test rejects, %", report::kTitleSize,
           Anchor::kStart);
  draw_key(svg, 50.0);
  const double step = kWidth / static_cast<double>(curves.size());
  double left = kMargin;
  for (const PowerCurve& curve : curves) {
    const Box frame{left, kTop, left + step - kMargin - 10.0, kTop + kHeight};
    svg.text("title", {frame.left, kTop - 16.0},
             fmt::format("{}: {} differs", curve.title, curve.moves), report::kTextSize,
             Anchor::kStart);
    const Panel panel(curve, frame);
    panel.draw_axes(svg, curve);
    panel.draw_share(svg, curve, &PowerPoint::misfit, "term term-0");
    panel.draw_share(svg, curve, &PowerPoint::published, "term term-1");
    panel.draw_share(svg, curve, &PowerPoint::predicted, "model");
    panel.draw_marks(svg, curve);
    left += step;
  }
  svg.close("svg");
  return svg.str();
}

}  // namespace imunoise::testing
