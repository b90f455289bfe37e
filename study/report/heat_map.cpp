#include "study/report/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/report/budget_layout.h"
#include "study/report/svg_plot.h"
#include "study/report/svg_writer.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr double kSteps = 4.0;       // steps of colour on either side
constexpr double kFullColour = 6.0;  // σ
constexpr double kRow = 24.0;        // px
constexpr double kGap = 2.0;         // px between cells
constexpr double kFoot = 44.0;       // px, for the labels of the columns
constexpr double kMostNames = 0.4;   // of the width

std::string draw(const HeatMap& map, const char* kind, double width) {
  double names = 0.0;
  for (const std::string& row : map.rows) names = std::max(names, text_width(row, kTextSize));
  const double left = std::min(names, kMostNames * width) + 12.0;
  const double step = (width - left - 4.0) / static_cast<double>(map.columns.size());
  const double bottom = kRow * static_cast<double>(map.rows.size());
  SvgWriter svg;
  svg.raw(page_opening(kind, width, bottom + kFoot, map.title));
  const auto letters = static_cast<std::size_t>(left / text_width("x", kTextSize));
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    const double top = kRow * static_cast<double>(r);
    svg.text("key", {left - 8.0, top + 16.0}, shorten(clean_text(map.rows[r]), letters), kTextSize,
             Anchor::kEnd);
    for (std::size_t c = 0; c < map.cells[r].size(); ++c) {
      const std::optional<HeatCell>& cell = map.cells[r][c];
      if (!cell) continue;
      const Box box{left + step * static_cast<double>(c), top + kGap,
                    left + step * static_cast<double>(c + 1) - kGap, top + kRow};
      svg.rect(cell_class(cell->sigma), box);
      if (cell->mark.empty() || text_width(cell->mark, 10.0) > step - kGap) continue;
      svg.text("cell-mark", {0.5 * (box.left + box.right), box.bottom - 7.0}, cell->mark, 10.0,
               Anchor::kMiddle);
    }
  }
  double free_from = 0.0;  // a label is left out where the one before reaches into it
  for (std::size_t c = 0; c < map.columns.size(); ++c) {
    const double x = left + step * (static_cast<double>(c) + 0.5);
    const double half = 0.5 * text_width(map.columns[c], kTickSize);
    if (map.columns[c].empty() || x - half < free_from || x + half > width) continue;
    svg.text("tick", {x, bottom + 16.0}, map.columns[c], kTickSize, Anchor::kMiddle);
    free_from = x + half + 6.0;
  }
  svg.text("axis-title", {0.5 * (left + width), bottom + 36.0}, map.axis_title, kTextSize,
           Anchor::kMiddle);
  svg.close("svg");
  return svg.str();
}

}  // namespace

std::optional<Figure> heat_map(const HeatMap& map) {
  if (map.rows.empty() || map.columns.empty()) return std::nullopt;
  return Figure{map.title, draw(map, "wide", 920.0), draw(map, "narrow", 388.0), map.caption};
}

std::string cell_class(double sigma) {
  const int step = std::min(static_cast<int>(kSteps),
                            static_cast<int>(kSteps * std::abs(sigma) / kFullColour + 0.5));
  return fmt::format("cell {}{}",
                     step == 0     ? "zero"
                     : sigma > 0.0 ? "plus"
                                   : "minus",
                     step == 0 ? "" : std::to_string(step));
}

}  // namespace imunoise::report
