#include "study/figure/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/figure/assets.h"
#include "study/figure/label_layout.h"
#include "study/figure/layout.h"
#include "study/figure/range.h"
#include "study/figure/svg_axes.h"
#include "study/figure/svg_layers.h"
#include "study/figure/svg_writer.h"
#include "study/words/text.h"

namespace imunoise::figure {
namespace {

constexpr double kLeastWidth = 200.0;  // px
constexpr double kLabelSize = 12.5;    // px, of the names along lines
constexpr double kLongName = 190.0;    // px
constexpr double kShortName = 100.0;
constexpr std::size_t kMostNames = 12;  // along lines; more cover what they name

std::string opening(const Figure& figure, const SvgOptions& options, const Layout& places) {
  const std::string extra = options.css_class.empty() ? "" : " " + options.css_class;
  std::string out = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" class="figure{0}" viewBox="0 0 {1} {2:.0f}" )"
      "width=\"{1}\" height=\"{2:.0f}\" role=\"img\" aria-label=\"{3}\">\n",
      report::escape_markup(extra), places.width, std::ceil(places.height),
      report::escape_markup(figure.sentence.empty() ? figure.title : figure.sentence));
  if (options.variant == SvgVariant::kStandalone) {
    out += "<style>\n" + plot_style_for_paper() + "</style>\n";
    out += "<rect class=\"paper\" x=\"0\" y=\"0\" width=\"100%\" height=\"100%\"/>\n";
  }
  return out;
}

void draw_heading(SvgWriter& svg, const Figure& figure, double width) {
  const double room = width - 8.0;
  if (!figure.title.empty())
    svg.text("title", {4.0, 22.0}, fitted(figure.title, kTitleSize, room), kTitleSize,
             Anchor::kStart);
  if (!figure.subtitle.empty())
    svg.text("subtitle", {4.0, 43.0}, fitted(figure.subtitle, kTextSize, room), kTextSize,
             Anchor::kStart);
}

void draw_key(SvgWriter& svg, const Layout& layout) {
  for (const KeyEntry& entry : layout.key) {
    draw_sign(svg, *entry.layer, entry.at);
    svg.text("key", {entry.at.x + 24.0, entry.at.y}, entry.layer->key, kTextSize, Anchor::kStart);
  }
}

// Names along the lines that have some, clear of all lines and points of the panel; says which of
// them have too little in the panel to be drawn.
std::string draw_line_names(SvgWriter& svg, const PanelPlace& place, bool narrow) {
  std::vector<const Layer*> named;
  std::vector<std::string> names;
  std::vector<std::vector<Point>> lines;
  std::vector<std::vector<Point>> others;
  std::vector<Point> obstacles;
  std::string absent;
  for (const Layer& layer : place.panel->layers) {
    if (layer.shape == Shape::kLine && layer.labelled) {
      named.push_back(&layer);
      names.push_back(fitted(layer.name, kLabelSize, narrow ? kShortName : kLongName));
      lines.push_back(line_points(place, layer));
      if (clipped(lines.back(), place.frame).empty())
        absent += (absent.empty() ? "" : ", ") + layer.name;
    } else if (layer.shape == Shape::kLine && layer.role != Role::kReplicate) {
      others.push_back(line_points(place, layer));
    } else if (layer.shape == Shape::kPoints) {
      const std::vector<Point> points = line_points(place, layer);
      obstacles.insert(obstacles.end(), points.begin(), points.end());
    }
  }
  if (names.size() > kMostNames) names.clear();
  lines.insert(lines.end(), others.begin(), others.end());
  for (const CurveLabel& label : place_labels(lines, names, obstacles, place.frame, kLabelSize)) {
    const Layer& layer = *named[label.curve];
    svg.open(fmt::format("g class=\"layer\" data-term=\"{}\"", report::escape_markup(layer.name)));
    svg.text(fmt::format("label term-{}", layer.style % kTermStyles), label.at, names[label.curve],
             kLabelSize, Anchor::kStart);
    svg.close("g");
  }
  return absent;
}

void draw_panel(SvgWriter& svg, const PanelPlace& place, const Axis& x, bool narrow) {
  svg.open("g class=\"panel\"");
  for (const Layer& layer : place.panel->layers) {
    if (is_background(layer)) draw_layer(svg, place, layer);
  }
  draw_grid(svg, place);
  draw_names(svg, place, x, narrow);
  for (const Layer& layer : place.panel->layers) {
    if (!is_background(layer)) draw_layer(svg, place, layer);
  }
  for (const PlacedText& words : place.marks)
    svg.text("note", words.at, words.text, kNoteSize, Anchor::kMiddle);
  const Box& frame = place.frame;
  const std::string absent = draw_line_names(svg, place, narrow);
  if (!absent.empty())
    svg.text("note", {frame.left, frame.bottom + (place.names_x ? -6.0 : 15.0)},
             fitted("too small to draw: " + absent, kNoteSize, frame.width()), kNoteSize,
             Anchor::kStart);
  if (!has_numbers(*place.panel))
    svg.text("note", {0.5 * (frame.left + frame.right), 0.5 * (frame.top + frame.bottom)},
             "no numbers to draw", kTextSize, Anchor::kMiddle);
  svg.close("g");
}

// Columns under the pointer, one a place of the first points, and the line that marks one of them.
void draw_cursor(SvgWriter& svg, const PanelPlace& place) {
  const auto points = std::find_if(place.panel->layers.begin(), place.panel->layers.end(),
                                   [](const Layer& one) { return one.shape == Shape::kPoints; });
  if (points == place.panel->layers.end()) return;
  std::vector<double> at;
  for (const Datum& one : points->data) {
    if (has_place(place.x.kind(), one.x)) at.push_back(place.at(one.x, place.y.low()).x);
  }
  const Box& stack = place.stack;
  svg.line("guide", {stack.left, stack.top}, {stack.left, stack.bottom});
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double left = k == 0 ? stack.left : 0.5 * (at[k - 1] + at[k]);
    const double right = k + 1 == at.size() ? stack.right : 0.5 * (at[k] + at[k + 1]);
    svg.rect("column", {left, stack.top, right, stack.bottom},
             fmt::format(R"(data-index="{}" data-at="{:.2f}")", k, at[k]));
  }
}

}  // namespace

std::string svg(const Figure& figure, const SvgOptions& options) {
  const bool standalone = options.variant == SvgVariant::kStandalone;
  const Paper paper{std::max(options.width, kLeastWidth), options.height, standalone};
  const Layout places = layout(figure, paper);
  SvgWriter out;
  out.raw(opening(figure, options, places));
  if (standalone) draw_heading(out, figure, paper.width);
  draw_key(out, places);
  const Axis* x = nullptr;
  for (const PanelPlace& place : places.panels) {
    if (x == nullptr || !place.panel->shares_x) x = &place.panel->x;
    draw_panel(out, place, *x, paper.narrow());
  }
  for (const PlacedText& words : places.caption)
    out.text("note", words.at, words.text, kNoteSize, Anchor::kStart);
  if (!standalone && figure.cursor && !places.panels.empty())
    draw_cursor(out, places.panels.front());
  out.close("svg");
  return out.str();
}

}  // namespace imunoise::figure
