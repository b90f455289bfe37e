#include "study/report/interval_chart.h"

#include <algorithm>
#include <cmath>

#include "study/report/axis.h"
#include "study/report/number.h"
#include "study/report/svg_plot.h"
#include "study/report/svg_writer.h"
#include "study/report/text.h"

namespace imunoise::report {
namespace {

constexpr double kRow = 26.0;     // px
constexpr double kLetter = 12.0;  // px
constexpr double kFoot = 44.0;    // px, for the axis
constexpr double kRight = 30.0;   // px, for half of the last label

std::string draw(const std::string& title, const std::string& axis_title,
                 const std::vector<IntervalRow>& rows, std::optional<double> reference,
                 const char* kind, double width) {
  LogRange range;
  if (reference) range.include(*reference);
  double names = 0.0;
  for (const IntervalRow& row : rows) {
    range.include(row.value);
    range.include(row.upper);
    range.include(std::max(row.lower, 0.2 * row.value));
    names = std::max(names, text_width(row.name, kLetter));
  }
  const double left = std::min(names, 0.45 * width) + 14.0;
  const LogAxis axis(range.low() * 0.9, range.high() * 1.1, left, width - kRight);
  const double bottom = kRow * static_cast<double>(rows.size()) + 6.0;
  SvgWriter svg;
  svg.raw(page_opening(kind, width, bottom + kFoot, title));
  for (const Tick& tick : axis.fine_ticks(52.0)) {
    const double x = axis(tick.value);
    svg.line(tick.major ? "grid" : "grid minor", {x, 0.0}, {x, bottom});
    if (!tick.major) continue;
    svg.text("tick", {x, bottom + 16.0}, tick_label(tick.value), kLetter, Anchor::kMiddle);
  }
  if (reference) svg.line("axis", {axis(*reference), 0.0}, {axis(*reference), bottom});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const IntervalRow& row = rows[i];
    const double y = kRow * (static_cast<double>(i) + 0.5);
    const auto columns = static_cast<std::size_t>(left / text_width("x", kLetter));
    svg.text("key", {left - 10.0, y + 4.0}, shorten(clean_text(row.name), columns), kLetter,
             Anchor::kEnd);
    const double from = row.lower > axis.low() ? axis(row.lower) : axis.begin();
    const double upper = row.upper > row.value ? row.upper : row.value;
    svg.line(row.marked ? "stem outside" : "stem", {from, y},
             {std::min(axis(upper), axis.end()), y});
    svg.circle(row.marked ? "residual outside" : "residual", {axis(row.value), y}, 4.0);
  }
  svg.text("axis-title", {0.5 * (axis.begin() + axis.end()), bottom + 36.0}, axis_title, kLetter,
           Anchor::kMiddle);
  svg.close("svg");
  return svg.str();
}

}  // namespace

std::optional<Figure> interval_chart(const std::string& title, const std::string& axis_title,
                                     const std::string& caption, std::vector<IntervalRow> rows,
                                     std::optional<double> reference) {
  std::erase_if(
      rows, [](const IntervalRow& row) { return !std::isfinite(row.value) || row.value <= 0.0; });
  if (rows.empty()) return std::nullopt;
  return Figure{title, draw(title, axis_title, rows, reference, "wide", 920.0),
                draw(title, axis_title, rows, reference, "narrow", 388.0), caption};
}

}  // namespace imunoise::report
