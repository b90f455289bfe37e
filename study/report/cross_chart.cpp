#include "study/report/cross_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "study/report/axis.h"
#include "study/report/budget_layout.h"
#include "study/report/svg_plot.h"
#include "study/report/svg_writer.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr int kMostPanels = 24;
constexpr double kPanel = 110.0;  // px, height of a frame
constexpr double kHead = 26.0;    // px above a frame, for its name
constexpr double kFoot = 28.0;    // px below, for the times
constexpr double kMargin = 34.0;  // px left of a frame
constexpr double kRadius = 2.2;   // px

using PairList = std::vector<const v1::SensorPair*>;

PairList shown(const v1::ArrayReport& report) {
  PairList out;
  const bool all = report.pairs_size() <= kMostPanels;
  for (const v1::SensorPair& pair : report.pairs()) {
    const bool room = static_cast<int>(out.size()) < kMostPanels;
    if (pair.scales_size() > 1 && room && (all || pair.dependent())) out.push_back(&pair);
  }
  return out;
}

void draw_panel(SvgWriter& svg, const v1::SensorPair& pair, const Box& frame) {
  const LogAxis time(pair.scales(0).tau_s() / 1.2,
                     pair.scales(pair.scales_size() - 1).tau_s() * 1.2, frame.left, frame.right);
  const auto y = [&](double correlation) {
    return frame.bottom +
           (frame.top - frame.bottom) * 0.5 * (1.0 + std::clamp(correlation, -1.0, 1.0));
  };
  const auto columns =
      static_cast<std::size_t>((frame.right - frame.left) / text_width("x", kTextSize));
  svg.text("key", {frame.left, frame.top - 8.0},
           shorten(clean_text(pair.first() + ", " + pair.second()), columns), kTextSize,
           Anchor::kStart);
  for (const double r : {-1.0, 0.0, 1.0}) {
    svg.line(r == 0.0 ? "axis" : "grid", {frame.left, y(r)}, {frame.right, y(r)});
    svg.text("tick", {frame.left - 6.0, y(r) + 4.0}, r < 0.0 ? "−1" : tick_label(r), kTickSize,
             Anchor::kEnd);
  }
  for (const int j : {0, pair.scales_size() / 2, pair.scales_size() - 1}) {
    const double x = time(pair.scales(j).tau_s());
    svg.line("axis", {x, frame.bottom}, {x, frame.bottom + 4.0});
    svg.text("tick", {x, frame.bottom + 18.0}, duration(pair.scales(j).tau_s()), kTickSize,
             j == 0                        ? Anchor::kStart
             : j == pair.scales_size() - 1 ? Anchor::kEnd
                                           : Anchor::kMiddle);
  }
  std::vector<Point> band;
  std::vector<Point> lower;
  std::vector<Point> model;
  for (const v1::CrossScale& scale : pair.scales()) {
    const double x = time(scale.tau_s());
    band.push_back({x, y(scale.upper() / scale.unit())});
    lower.push_back({x, y(scale.lower() / scale.unit())});
    model.push_back({x, y(scale.model() / scale.unit())});
  }
  band.insert(band.end(), lower.rbegin(), lower.rend());
  svg.path("band", band, true);
  svg.path("model", model);
  for (const v1::CrossScale& scale : pair.scales()) {
    const bool outside = scale.model() < scale.lower() || scale.model() > scale.upper();
    svg.circle(outside ? "measured outside" : "measured",
               {time(scale.tau_s()), y(scale.covariance() / scale.unit())}, kRadius);
  }
}

std::string draw(const PairList& pairs, const char* kind, double width, std::size_t columns) {
  const std::size_t rows = (pairs.size() + columns - 1) / columns;
  const double pitch = kHead + kPanel + kFoot;
  SvgWriter svg;
  svg.raw(page_opening(kind, width, pitch * static_cast<double>(rows),
                       "Wavelet cross-covariance of each pair of sensors"));
  const double step = width / static_cast<double>(columns);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double left = step * static_cast<double>(i % columns) + kMargin;
    const double top = pitch * static_cast<double>(i / columns) + kHead;
    draw_panel(svg, *pairs[i], {left, top, left + step - kMargin - 14.0, top + kPanel});
  }
  svg.close("svg");
  return svg.str();
}

}  // namespace

std::optional<Figure> cross_chart(const v1::ArrayReport& report) {
  const PairList pairs = shown(report);
  if (pairs.empty()) return std::nullopt;
  const std::size_t columns = std::min<std::size_t>(3, pairs.size());
  std::string caption =
      "Wavelet cross-covariance over averaging time, divided by the root of the two sensors' "
      "wavelet "
      "variances: 1 and −1 are noise that both share entirely. Dots and band: measured, with "
      "intervals made without the model; line: the model; orange: it lies outside the interval.";
  if (static_cast<int>(pairs.size()) < report.pairs_size()) {
    caption += fmt::format(" Shown are {} of {} pairs, those that share noise.", pairs.size(),
                           report.pairs_size());
  }
  return Figure{"What each pair of sensors shares", draw(pairs, "wide", 920.0, columns),
                draw(pairs, "narrow", 388.0, 1), caption};
}

}  // namespace imunoise::report
