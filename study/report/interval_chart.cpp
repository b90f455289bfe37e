#include "study/report/interval_chart.h"

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

constexpr double kRow = 26.0;     // px
constexpr double kLetter = 12.0;  // px
constexpr double kFoot = 44.0;    // px, for the axis
constexpr double kRight = 30.0;   // px, for half of the last label

// What a chart shows, apart from where.
struct Chart {
  const std::string& axis_title;
  const std::vector<IntervalRow>& rows;
  std::optional<double> reference;
  double height() const { return kRow * static_cast<double>(rows.size()) + 6.0 + kFoot; }
};

// Draws it `width` wide, `top` below the upper edge.
void draw(SvgWriter& svg, const Chart& chart, double width, double top) {
  LogRange range;
  if (chart.reference) range.include(*chart.reference);
  double names = 0.0;
  for (const IntervalRow& row : chart.rows) {
    range.include(row.value);
    range.include(row.upper);
    range.include(std::max(row.lower, 0.2 * row.value));
    names = std::max(names, text_width(row.name, kLetter));
  }
  const double left = std::min(names, 0.45 * width) + 14.0;
  const LogAxis axis(range.low() * 0.9, range.high() * 1.1, left, width - kRight);
  const double bottom = top + chart.height() - kFoot;
  for (const Tick& tick : axis.fine_ticks(52.0)) {
    const double x = axis(tick.value);
    svg.line(tick.major ? "grid" : "grid minor", {x, top}, {x, bottom});
    if (!tick.major) continue;
    svg.text("tick", {x, bottom + 16.0}, tick_label(tick.value), kLetter, Anchor::kMiddle);
  }
  if (chart.reference)
    svg.line("axis", {axis(*chart.reference), top}, {axis(*chart.reference), bottom});
  for (std::size_t i = 0; i < chart.rows.size(); ++i) {
    const IntervalRow& row = chart.rows[i];
    const double y = top + kRow * (static_cast<double>(i) + 0.5);
    const auto columns = static_cast<std::size_t>(left / text_width("x", kLetter));
    svg.text("key", {left - 10.0, y + 4.0}, shorten(clean_text(row.name), columns), kLetter,
             Anchor::kEnd);
    const double from = row.lower > axis.low() ? axis(row.lower) : axis.begin();
    const double upper = row.upper > row.value ? row.upper : row.value;
    svg.line(row.marked ? "stem outside" : "stem", {from, y},
             {std::min(axis(upper), axis.end()), y});
    svg.circle(row.marked ? "residual outside" : "residual", {axis(row.value), y}, 4.0);
  }
  svg.text("axis-title", {0.5 * (axis.begin() + axis.end()), bottom + 36.0}, chart.axis_title,
           kLetter, Anchor::kMiddle);
}

std::string inline_chart(const std::string& title, const Chart& chart, const char* kind,
                         double width) {
  SvgWriter svg;
  svg.raw(page_opening(kind, width, chart.height(), title));
  draw(svg, chart, width, 0.0);
  svg.close("svg");
  return svg.str();
}

void drop_what_has_no_place(std::vector<IntervalRow>& rows) {
  std::erase_if(
      rows, [](const IntervalRow& row) { return !std::isfinite(row.value) || row.value <= 0.0; });
}

}  // namespace

std::optional<Figure> interval_chart(const std::string& title, const std::string& axis_title,
                                     const std::string& caption, std::vector<IntervalRow> rows,
                                     std::optional<double> reference) {
  drop_what_has_no_place(rows);
  if (rows.empty()) return std::nullopt;
  const Chart chart{axis_title, rows, reference};
  return Figure{title, inline_chart(title, chart, "wide", 920.0),
                inline_chart(title, chart, "narrow", 388.0), caption};
}

std::string interval_svg(const std::string& title, const std::string& subtitle,
                         const std::string& axis_title, std::vector<IntervalRow> rows,
                         std::optional<double> reference) {
  constexpr double kWidth = 900.0;
  constexpr double kTop = 60.0;
  drop_what_has_no_place(rows);
  if (rows.empty()) return "";
  const Chart chart{axis_title, rows, reference};
  SvgWriter svg;
  svg.raw(svg_opening({SvgVariant::kStandalone, kWidth, "interval"}, kTop + chart.height(), title));
  svg.text("title", {4.0, 22.0}, title, kTitleSize, Anchor::kStart);
  svg.text("subtitle", {4.0, 43.0}, subtitle, kTextSize, Anchor::kStart);
  draw(svg, chart, kWidth, kTop);
  svg.close("svg");
  return svg.str();
}

}  // namespace imunoise::report
