#include "study/figure/svg_axes.h"

#include <algorithm>
#include <cmath>

#include "study/words/text.h"

namespace imunoise::figure {
namespace {

constexpr double kTickLength = 5.0;     // px
constexpr double kMinorLength = 3.0;    // px
constexpr double kBaselineShift = 4.0;  // px from the middle of a line of text to its baseline
constexpr double kRightLabel = 20.0;    // px a label of the right axis needs

bool is_categories(const Scale& scale) { return scale.kind() == AxisKind::kCategories; }

// Axes of decades show their minor ticks as well.
bool shows_minor(const Scale& scale) { return scale.kind() == AxisKind::kLogarithmic; }

void draw_label(SvgWriter& svg, Point at, const Tick& tick, Anchor anchor) {
  if (tick.exponent) {
    svg.power_of_ten("tick", at, *tick.exponent, kTickSize, anchor);
  } else {
    svg.text("tick", at, tick.label, kTickSize, anchor);
  }
}

double height_of(const PanelPlace& place, double value) {
  return place.frame.bottom - place.y(value) * place.frame.height();
}

double column_of(const PanelPlace& place, double value) {
  return place.frame.left + place.x(value) * place.frame.width();
}

const std::string& short_or_long(const std::string& brief, const std::string& title, bool narrow) {
  return narrow && !brief.empty() ? brief : title;
}

void draw_left_names(SvgWriter& svg, const PanelPlace& place) {
  const Box& frame = place.frame;
  for (const Tick& tick : place.y_ticks) {
    if (!tick.major) continue;
    if (is_categories(place.y)) {
      const double y = frame.top + place.y(tick.value) * frame.height();
      const double room = frame.left - place.left - 12.0;
      svg.text("key", {frame.left - 10.0, y + kBaselineShift}, fitted(tick.label, kTickSize, room),
               kTickSize, Anchor::kEnd);
    } else {
      draw_label(svg, {frame.left - 8.0, height_of(place, tick.value) + kBaselineShift}, tick,
                 Anchor::kEnd);
    }
  }
}

void draw_right_names(SvgWriter& svg, const PanelPlace& place, const RightAxis& axis) {
  const Box& frame = place.frame;
  const Scale right = place.y.relabelled(axis.factor, axis.exponent);
  for (const Tick& tick : right.ticks(frame.height(), kRightLabel, 14.0)) {
    const double y = frame.bottom - right(tick.value) * frame.height();
    svg.line("axis", {frame.right, y},
             {frame.right + (tick.major ? kTickLength : kMinorLength), y});
    if (tick.major) draw_label(svg, {frame.right + 9.0, y + kBaselineShift}, tick, Anchor::kStart);
  }
  svg.line("axis", {frame.right, frame.top}, {frame.right, frame.bottom});
}

// Labels keep inside the panel's part of the picture and apart from each other.
void draw_bottom_names(SvgWriter& svg, const PanelPlace& place, const std::string& title) {
  const Box& frame = place.frame;
  double free_from = place.left;
  for (const Tick& tick : place.x_ticks) {
    const double x = column_of(place, tick.value);
    svg.line("axis", {x, frame.bottom},
             {x, frame.bottom + (tick.major ? kTickLength : kMinorLength)});
    if (!tick.major) continue;
    const double half = 0.5 * text_width(label_text(tick), kTickSize);
    const double middle =
        std::clamp(x, place.left + half, std::max(place.left + half, place.right - half));
    if (middle - half < free_from) continue;
    draw_label(svg, {middle, frame.bottom + 20.0}, tick, Anchor::kMiddle);
    free_from = middle + half + 6.0;
  }
  const double room = place.right - place.left - 8.0;
  const std::string words = fitted(title, kTextSize, room);
  const double half = 0.5 * text_width(words, kTextSize);
  const double middle = std::clamp(0.5 * (frame.left + frame.right), place.left + half,
                                   std::max(place.left + half, place.right - half));
  if (!words.empty())
    svg.text("axis-title", {middle, frame.bottom + 39.0}, words, kTextSize, Anchor::kMiddle);
}

void draw_head(SvgWriter& svg, const PanelPlace& place, bool narrow) {
  const Panel& panel = *place.panel;
  const auto pair = [&](const char* css_class, double baseline, const std::string& left,
                        const std::string& right, double from, double to) {
    // Names may come from a file: each keeps to its half where there are two.
    const double room = (to - from) * (left.empty() || right.empty() ? 1.0 : 0.49);
    if (!left.empty())
      svg.text(css_class, {from, baseline}, fitted(left, kTextSize, room), kTextSize,
               Anchor::kStart);
    if (!right.empty())
      svg.text(css_class, {to, baseline}, fitted(right, kTextSize, room), kTextSize, Anchor::kEnd);
  };
  pair("key", place.title_baseline, panel.title, panel.note, place.frame.left, place.frame.right);
  const std::string right =
      panel.right ? short_or_long(panel.right->short_title, panel.right->title, narrow) : "";
  pair("axis-title", place.axis_baseline, short_or_long(panel.y.short_title, panel.y.title, narrow),
       right, place.left + 4.0, place.right - 4.0);
}

}  // namespace

void draw_grid(SvgWriter& svg, const PanelPlace& place) {
  const Box& frame = place.frame;
  if (!is_categories(place.x)) {
    for (const Tick& tick : place.x_ticks) {
      const double x = column_of(place, tick.value);
      svg.line(tick.major ? "grid" : "grid minor", {x, frame.top}, {x, frame.bottom});
    }
  }
  if (!is_categories(place.y)) {
    for (const Tick& tick : place.y_ticks) {
      const double y = height_of(place, tick.value);
      if (tick.major || place.y.kind() == AxisKind::kSigma) {
        svg.line(tick.value == 0.0 ? "axis" : "grid", {frame.left, y}, {frame.right, y});
      } else if (shows_minor(place.y)) {
        svg.line("axis", {frame.left - kMinorLength, y}, {frame.left, y});
      }
    }
  }
  const Panel& panel = *place.panel;
  if (panel.y_reference && place.y.holds(*panel.y_reference)) {
    const double y = height_of(place, *panel.y_reference);
    svg.line("axis", {frame.left, y}, {frame.right, y});
  }
  if (panel.x_reference && place.x.holds(*panel.x_reference)) {
    const double x = column_of(place, *panel.x_reference);
    svg.line("axis", {x, frame.top}, {x, frame.bottom});
  }
  if (shows_minor(place.y)) svg.line("axis", {frame.left, frame.top}, {frame.left, frame.bottom});
}

void draw_names(SvgWriter& svg, const PanelPlace& place, const Axis& x, bool narrow) {
  draw_head(svg, place, narrow);
  draw_left_names(svg, place);
  if (place.panel->right) draw_right_names(svg, place, *place.panel->right);
  if (!place.names_x) return;
  if (!is_categories(place.x))
    svg.line("axis", {place.frame.left, place.frame.bottom},
             {place.frame.right, place.frame.bottom});
  draw_bottom_names(svg, place, short_or_long(x.short_title, x.title, narrow));
}

}  // namespace imunoise::figure
