#include "tests/core/array/gain_figure.h"

#include <fmt/format.h>

#include <cmath>

#include "study/report/axis.h"
#include "study/report/budget_layout.h"
#include "study/report/svg_plot.h"
#include "study/report/svg_writer.h"
#include "study/words/number.h"

namespace imunoise::testing {
namespace {

using report::Anchor;
using report::Box;
using report::LogAxis;
using report::LogRange;
using report::Point;
using report::SvgWriter;

constexpr double kWidth = 900.0;   // px
constexpr double kTop = 112.0;     // px, of the frames
constexpr double kHeight = 250.0;  // px, of a frame
constexpr double kMargin = 52.0;   // px, left of a frame
constexpr double kRadius = 2.6;    // px

LogRange range_of(const std::vector<GainPanel>& panels) {
  LogRange out;
  out.include(1.0);
  for (const GainPanel& panel : panels) {
    for (const GainCurve& curve : panel.curves) {
      for (const double r : curve.predicted) out.include(r);
      for (Eigen::Index j = 0; j < curve.measured.size(); ++j) {
        const double reach = std::exp(1.96 * curve.measured_error(j));
        out.include(curve.measured(j) * reach);
        out.include(curve.measured(j) / reach);
      }
    }
  }
  return out;
}

void draw_panel(SvgWriter& svg, const GainPanel& panel, const Box& frame, const LogAxis& gain) {
  const auto scales = static_cast<double>(panel.curves.front().predicted.size());
  const auto x = [&](Eigen::Index j) {
    const double share = (static_cast<double>(j) + 0.5) / scales;
    return frame.left + share * (frame.right - frame.left);
  };
  for (const report::Tick& tick : gain.fine_ticks(22.0)) {
    const double y = gain(tick.value);
    svg.line(tick.major ? "grid" : "grid minor", {frame.left, y}, {frame.right, y});
    if (!tick.major) continue;
    svg.text("tick", {frame.left - 7.0, y + 4.0}, report::tick_label(tick.value), report::kTickSize,
             Anchor::kEnd);
  }
  svg.line("axis", {frame.left, gain(1.0)}, {frame.right, gain(1.0)});
  svg.line("axis", {frame.left, frame.bottom}, {frame.right, frame.bottom});
  for (Eigen::Index j = 0; j < panel.curves.front().predicted.size(); ++j) {
    svg.line("axis", {x(j), frame.bottom}, {x(j), frame.bottom + 4.0});
    if (j % 3 != 0) continue;
    svg.text("tick", {x(j), frame.bottom + 18.0}, fmt::format("{}", j + 1), report::kTickSize,
             Anchor::kMiddle);
  }
  svg.text("axis-title", {0.5 * (frame.left + frame.right), frame.bottom + 37.0}, "scale",
           report::kTextSize, Anchor::kMiddle);
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    const GainCurve& curve = panel.curves[c];
    std::vector<Point> line;
    for (Eigen::Index j = 0; j < curve.predicted.size(); ++j) {
      line.push_back({x(j), gain(curve.predicted(j))});
    }
    svg.path(fmt::format("term term-{}", c), line);
    for (Eigen::Index j = 0; j < curve.measured.size(); ++j) {
      const double reach = std::exp(1.96 * curve.measured_error(j));
      svg.line("whisker", {x(j), gain(curve.measured(j) * reach)},
               {x(j), gain(curve.measured(j) / reach)});
      svg.circle("measured", {x(j), gain(curve.measured(j))}, kRadius);
    }
  }
  svg.text("title", {frame.left, frame.top - 14.0}, panel.title, report::kTextSize, Anchor::kStart);
}

void draw_key(SvgWriter& svg, const GainPanel& panel, double baseline) {
  double left = 4.0;
  const auto words = [&](const std::string& text) {
    svg.text("key", {left + 30.0, baseline}, text, report::kTextSize, Anchor::kStart);
    left += 30.0 + report::text_width(text, report::kTextSize) + 14.0;
  };
  bool measured = false;
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    svg.path(fmt::format("term term-{}", c),
             {{left, baseline - 4.0}, {left + 24.0, baseline - 4.0}});
    words(panel.curves.size() > 1 ? "made for " + panel.curves[c].name : "by the fitted model");
    measured = measured || panel.curves[c].measured.size() > 0;
  }
  if (!measured) return;
  svg.circle("measured", {left + 12.0, baseline - 4.0}, kRadius);
  words("measured on held-out data, 95 %");
}

}  // namespace

std::string gain_figure(const std::string& title, const std::vector<GainPanel>& panels) {
  SvgWriter svg;
  svg.raw(report::svg_opening({report::SvgVariant::kStandalone, kWidth, "gain"},
                              kTop + kHeight + 50.0, title));
  svg.text("title", {4.0, 22.0}, title, report::kTitleSize, Anchor::kStart);
  svg.text("subtitle", {4.0, 42.0},
           "Wavelet variance of the virtual sensor over that of the sensors' mean: below 1 it is "
           "quieter.",
           report::kTextSize, Anchor::kStart);
  draw_key(svg, panels.front(), 64.0);
  const LogRange range = range_of(panels);
  const LogAxis gain(range.low() / 1.1, range.high() * 1.1, kTop + kHeight, kTop);
  const double step = kWidth / static_cast<double>(panels.size());
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const double left = step * static_cast<double>(p) + kMargin;
    draw_panel(svg, panels[p], {left, kTop, left + step - kMargin - 10.0, kTop + kHeight}, gain);
  }
  svg.close("svg");
  return svg.str();
}

}  // namespace imunoise::testing
