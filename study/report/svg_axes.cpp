#include "study/report/svg_axes.h"

#include <cmath>

#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr double kTickLength = 5.0;     // px
constexpr double kBaselineShift = 4.0;  // px from the middle of a line of text to its baseline
constexpr double kLabelHeight = 20.0;   // px a label needs on a vertical axis
constexpr double kLabelWidth = 42.0;    // px a label needs on a horizontal axis

int exponent_of(double decade) { return static_cast<int>(std::lround(std::log10(decade))); }

// "0.02", "500", 10⁵, "2e-7": as short as its size allows.
void draw_number(SvgWriter& svg, Point at, double value, Anchor anchor) {
  const double log = std::log10(value);
  if (log > -3.01 && log < 3.9) {
    svg.text("tick", at, tick_label(value), kTickSize, anchor);
  } else if (std::abs(log - std::round(log)) < 1e-9) {
    svg.power_of_ten("tick", at, exponent_of(value), kTickSize, anchor);
  } else {
    svg.text("tick", at, number(value, 1, Digits::kPlain), kTickSize, anchor);
  }
}

}  // namespace

void draw_variance_axes(SvgWriter& svg, const BudgetLayout& layout, const std::string& unit) {
  const Box& frame = layout.budget;
  for (const Tick& tick : layout.variance.decade_ticks(kLabelHeight)) {
    const double y = layout.variance(tick.value);
    if (!tick.major) {
      svg.line("axis", {frame.left - 3.0, y}, {frame.left, y});
      continue;
    }
    svg.line("grid", {frame.left, y}, {frame.right, y});
    svg.power_of_ten("tick", {frame.left - 8.0, y + kBaselineShift}, exponent_of(tick.value),
                     kTickSize, Anchor::kEnd);
  }
  const AllanUnit allan = allan_unit(unit);
  const LogAxis deviation(allan.deviation(layout.variance.low()),
                          allan.deviation(layout.variance.high()), frame.bottom, frame.top);
  for (const Tick& tick : deviation.fine_ticks(kLabelHeight)) {
    const double y = deviation(tick.value);
    svg.line("axis", {frame.right, y}, {frame.right + (tick.major ? kTickLength : 3.0), y});
    if (!tick.major) continue;
    const Point at{frame.right + 9.0, y + kBaselineShift};
    draw_number(svg, at, tick.value, Anchor::kStart);
  }
  svg.line("axis", {frame.left, frame.top}, {frame.left, frame.bottom});
  svg.line("axis", {frame.right, frame.top}, {frame.right, frame.bottom});
  const bool narrow = layout.width < kNarrow;
  const double y = frame.top - 14.0;
  // Units may come from a file: each title keeps to its half.
  const auto half =
      static_cast<std::size_t>((0.5 * layout.width - 8.0) / text_width("x", kTextSize));
  const auto title = [&](Point at, const std::string& text, Anchor anchor) {
    svg.text("axis-title", at, shorten(clean_text(text), half), kTextSize, anchor);
  };
  title({4.0, y}, (narrow ? "ν, " : "wavelet variance ν, ") + squared(unit), Anchor::kStart);
  title({layout.width - 4.0, y}, (narrow ? "Allan dev., " : "Allan deviation √(2ν), ") + allan.unit,
        Anchor::kEnd);
}

void draw_time_grid(SvgWriter& svg, const LogAxis& time, const Box& frame) {
  for (const Tick& tick : time.decade_ticks(kLabelWidth)) {
    const double x = time(tick.value);
    svg.line(tick.major ? "grid" : "grid minor", {x, frame.top}, {x, frame.bottom});
  }
}

void draw_time_labels(SvgWriter& svg, const LogAxis& time, const Box& frame) {
  svg.line("axis", {frame.left, frame.bottom}, {frame.right, frame.bottom});
  for (const Tick& tick : time.decade_ticks(kLabelWidth)) {
    const double x = time(tick.value);
    svg.line("axis", {x, frame.bottom}, {x, frame.bottom + (tick.major ? kTickLength : 3.0)});
    if (!tick.major) continue;
    draw_number(svg, {x, frame.bottom + 20.0}, tick.value, Anchor::kMiddle);
  }
  svg.text("axis-title", {0.5 * (frame.left + frame.right), frame.bottom + 39.0},
           "averaging time, s", kTextSize, Anchor::kMiddle);
}

}  // namespace imunoise::report
