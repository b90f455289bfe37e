#include "study/figure/svg_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/figure/svg_style.h"
#include "study/words/text.h"

namespace imunoise::figure {
namespace {

constexpr double kRadius = 3.4;       // px
constexpr double kSmallRadius = 2.4;  // px, in low panels
constexpr double kCellGap = 2.0;      // px
constexpr double kHatchStep = 7.0;    // px
constexpr double kBarShare = 0.6;     // of the room of a category

double radius_of(const PanelPlace& place) {
  return place.frame.height() < kLowPanel && place.y.kind() != AxisKind::kSigma ? kSmallRadius
                                                                                : kRadius;
}

bool has_x(const PanelPlace& place, double x) { return has_place(place.x.kind(), x); }
bool has_y(const PanelPlace& place, double y) { return has_place(place.y.kind(), y); }

double across(const PanelPlace& place, double x) { return place.at(x, place.y.low()).x; }
double up(const PanelPlace& place, double y) { return place.at(place.x.low(), y).y; }

// Unknown ends run to the frame's edge.
double lower_end(const PanelPlace& place, double y) {
  return has_y(place, y) ? std::clamp(up(place, y), place.frame.top, place.frame.bottom)
                         : place.frame.bottom;
}
double upper_end(const PanelPlace& place, double y) {
  return has_y(place, y) ? std::clamp(up(place, y), place.frame.top, place.frame.bottom)
                         : place.frame.top;
}
double left_end(const PanelPlace& place, double x) {
  return has_x(place, x) ? std::clamp(across(place, x), place.frame.left, place.frame.right)
                         : place.frame.left;
}
double right_end(const PanelPlace& place, double x) {
  return has_x(place, x) ? std::clamp(across(place, x), place.frame.left, place.frame.right)
                         : place.frame.right;
}

void draw_line(SvgWriter& svg, const PanelPlace& place, const Layer& layer) {
  svg.path(line_class(layer), clipped(line_points(place, layer), place.frame));
}

void draw_points(SvgWriter& svg, const PanelPlace& place, const Layer& layer) {
  for (const Datum& one : layer.data) {
    if (!has_x(place, one.x) || !has_y(place, one.y)) continue;
    const double x = left_end(place, one.x);
    if (std::isfinite(one.lower) || std::isfinite(one.upper))
      svg.line(with_state("whisker", one.state), {x, lower_end(place, one.lower)},
               {x, upper_end(place, one.upper)});
  }
  for (const Datum& one : layer.data) {
    if (!has_x(place, one.x) || !has_y(place, one.y)) continue;
    svg.circle(with_state("measured", one.state), place.frame.nearest(place.at(one.x, one.y)),
               radius_of(place), data_attributes(one));
  }
}

void draw_band(SvgWriter& svg, const PanelPlace& place, const Layer& layer) {
  std::vector<Point> outline;
  std::vector<Point> back;
  for (const Datum& one : layer.data) {
    if (!has_x(place, one.x) || (std::isnan(one.lower) && std::isnan(one.upper))) continue;
    const double x = left_end(place, one.x);
    const double top = upper_end(place, one.upper);
    outline.push_back({x, top});
    // A trace without height would not be seen.
    back.push_back(
        {x, std::max(lower_end(place, one.lower), std::min(top + 1.0, place.frame.bottom))});
  }
  outline.insert(outline.end(), back.rbegin(), back.rend());
  svg.area(area_class(layer), outline);
}

void draw_intervals(SvgWriter& svg, const PanelPlace& place, const Layer& layer) {
  for (const Datum& one : layer.data) {
    if (!has_x(place, one.x) || !place.y.holds(one.y)) continue;
    const Point at = place.frame.nearest(place.at(one.x, one.y));
    const double right =
        std::isfinite(one.upper) ? right_end(place, std::max(one.x, one.upper)) : at.x;
    const double left = std::isnan(one.lower) ? at.x : std::min(at.x, left_end(place, one.lower));
    svg.line(with_state("stem", one.state), {left, at.y}, {right, at.y});
    svg.circle(with_state("residual", one.state), at, 4.0, data_attributes(one));
  }
}

void draw_bar(SvgWriter& svg, const PanelPlace& place, const Layer& layer, const Datum& one) {
  const Box& frame = place.frame;
  const Point at = frame.nearest(place.at(one.x, one.y));
  const std::string css_class = with_state(bar_class(layer), one.state);
  if (place.y.kind() == AxisKind::kCategories) {
    const double zero = has_x(place, 0.0) ? left_end(place, 0.0) : frame.left;
    const double half = 0.5 * kBarShare * frame.height() / (place.y.high() - place.y.low());
    svg.rect(css_class, {std::min(zero, at.x), at.y - half, std::max(zero, at.x), at.y + half},
             data_attributes(one));
    return;
  }
  const double zero = has_y(place, 0.0) ? lower_end(place, 0.0) : frame.bottom;
  if (place.x.kind() == AxisKind::kCategories) {
    const double half = 0.5 * kBarShare * frame.width() / (place.x.high() - place.x.low());
    svg.rect(css_class, {at.x - half, std::min(zero, at.y), at.x + half, std::max(zero, at.y)},
             data_attributes(one));
    return;
  }
  svg.line(with_state("stem", one.state), {at.x, zero}, at);
  svg.circle(with_state("residual", one.state), at, kRadius, data_attributes(one));
}

void draw_marks(SvgWriter& svg, const PanelPlace& place, const Layer& layer) {
  for (const Datum& one : layer.data) {
    if (!has_x(place, one.x) || !place.x.holds(one.x)) continue;
    const double x = across(place, one.x);
    svg.line(with_state("mark", one.state), {x, place.frame.top - 4.0}, {x, place.frame.bottom});
  }
}

void draw_cells(SvgWriter& svg, const PanelPlace& place, const Layer& layer) {
  const double pitch = place.frame.height() / (place.y.high() - place.y.low());
  for (const Datum& one : layer.data) {
    if (!place.y.holds(one.y) || !std::isfinite(one.sigma)) continue;
    const double middle = up(place, one.y);
    Box box{left_end(place, one.lower), middle - 0.5 * pitch, right_end(place, one.upper),
            middle + 0.5 * pitch};
    box.right -= std::min(kCellGap, 0.2 * box.width());
    box.bottom -= std::min(kCellGap, 0.2 * pitch);
    svg.rect(cell_class(one.sigma), box, data_attributes(one));
    if (one.words.empty() || pitch < kCellSize + 4.0) continue;
    const std::string sign = one.words.starts_with("−") ? "−" : one.words.substr(0, 1);
    const bool whole = text_width(one.words, kCellSize) <= box.width();
    const bool brief = std::abs(one.sigma) > 2.0 && text_width(sign, kCellSize) <= box.width();
    if (!whole && !brief) continue;
    svg.text("cell-mark", {0.5 * (box.left + box.right), middle + 3.0}, whole ? one.words : sign,
             kCellSize, Anchor::kMiddle);
  }
}

// Diagonal lines, without a pattern: its id would have to differ from those of all other figures.
void draw_hatch(SvgWriter& svg, const Box& box) {
  std::vector<std::vector<Point>> lines;
  for (double x = box.left - box.height() + kHatchStep; x < box.right; x += kHatchStep) {
    const auto parts = clipped({{x, box.bottom}, {x + box.height(), box.top}}, box);
    lines.insert(lines.end(), parts.begin(), parts.end());
  }
  svg.path("hatch", lines);
}

void draw_columns(SvgWriter& svg, const PanelPlace& place, const Layer& layer) {
  for (const Datum& one : layer.data) {
    const Box box{left_end(place, one.lower), place.stack.top, right_end(place, one.upper),
                  place.stack.bottom};
    if (layer.role == Role::kUntested) {
      draw_hatch(svg, box);
    } else {
      svg.rect(role_name(layer.role), box);
    }
  }
}

void draw_rows(SvgWriter& svg, const PanelPlace& place, const Layer& layer) {
  for (const Datum& one : layer.data) {
    const double first = upper_end(place, one.upper);
    const double second = lower_end(place, one.lower);
    svg.rect(area_class(layer), {place.frame.left, std::min(first, second), place.frame.right,
                                 std::max(first, second)});
  }
}

}  // namespace

bool is_background(const Layer& layer) {
  const bool wash = layer.shape == Shape::kBand && layer.role != Role::kMeasured;
  return wash || layer.shape == Shape::kColumns || layer.shape == Shape::kRows;
}

std::vector<Point> line_points(const PanelPlace& place, const Layer& layer) {
  std::vector<Point> out;
  for (const Datum& one : layer.data) {
    if (has_x(place, one.x) && has_y(place, one.y)) out.push_back(place.at(one.x, one.y));
  }
  return out;
}

void draw_layer(SvgWriter& svg, const PanelPlace& place, const Layer& layer) {
  if (layer.data.empty()) return;
  const std::string term =
      layer.name.empty() ? "" : fmt::format(" data-term=\"{}\"", report::escape_markup(layer.name));
  svg.open(fmt::format("g class=\"layer\" data-role=\"{}\"{}", role_name(layer.role), term));
  switch (layer.shape) {
    case Shape::kLine:
      draw_line(svg, place, layer);
      break;
    case Shape::kPoints:
      draw_points(svg, place, layer);
      break;
    case Shape::kBand:
      draw_band(svg, place, layer);
      break;
    case Shape::kIntervals:
      draw_intervals(svg, place, layer);
      break;
    case Shape::kBars:
      for (const Datum& one : layer.data) {
        const bool held = place.x.kind() != AxisKind::kCategories || place.x.holds(one.x);
        if (held && has_x(place, one.x) && has_y(place, one.y)) draw_bar(svg, place, layer, one);
      }
      break;
    case Shape::kMarks:
      draw_marks(svg, place, layer);
      break;
    case Shape::kCells:
      draw_cells(svg, place, layer);
      break;
    case Shape::kColumns:
      draw_columns(svg, place, layer);
      break;
    case Shape::kRows:
      draw_rows(svg, place, layer);
      break;
  }
  svg.close("g");
}

void draw_sign(SvgWriter& svg, const Layer& layer, Point at) {
  const double y = at.y - 4.0;
  const Box box{at.x, y - 5.0, at.x + 18.0, y + 5.0};
  switch (layer.shape) {
    case Shape::kPoints:
      svg.line("whisker", {at.x + 9.0, y - 8.0}, {at.x + 9.0, y + 8.0});
      svg.circle("measured", {at.x + 9.0, y}, kRadius);
      return;
    case Shape::kLine:
      svg.path(line_class(layer), {{{at.x, y}, {at.x + 18.0, y}}});
      return;
    case Shape::kColumns:
      if (layer.role == Role::kUntested) {
        draw_hatch(svg, box);
        return;
      }
      [[fallthrough]];
    case Shape::kBand:
    case Shape::kRows:
      svg.rect(area_class(layer), box);
      return;
    case Shape::kIntervals:
    case Shape::kBars:
      svg.line("stem", {at.x, y}, {at.x + 18.0, y});
      svg.circle("residual", {at.x + 9.0, y}, kRadius);
      return;
    case Shape::kMarks:
      svg.line("mark", {at.x + 9.0, y - 7.0}, {at.x + 9.0, y + 7.0});
      return;
    case Shape::kCells:
      svg.rect(cell_class(kFullColour), box);
      return;
  }
}

}  // namespace imunoise::figure
