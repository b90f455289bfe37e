#include "study/report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/report/assets.h"
#include "study/report/budget_layout.h"
#include "study/report/label_layout.h"
#include "study/report/svg_axes.h"
#include "study/report/svg_residual.h"
#include "study/report/verdict.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr double kPointRadius = 3.4;  // px
constexpr double kLabelSize = 12.5;   // px, of the names beside the curves

// The drawable points of a curve, in px. A zero interrupts nothing: its neighbours are joined.
template <class Value>
std::vector<Point> curve(const std::vector<ScaleView>& scales, const BudgetLayout& layout,
                         Value value) {
  std::vector<Point> out;
  for (const ScaleView& scale : scales) {
    const double v = value(scale);
    if (drawable(v)) out.push_back({layout.time(scale.seconds), layout.variance(v)});
  }
  return out;
}

// The part of a polyline above `floor` (px): terms leave the plot through its lower edge.
std::vector<Point> above(const std::vector<Point>& points, double floor) {
  std::vector<Point> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && (points[i].y > floor) != (points[i - 1].y > floor)) {
      const double t = (floor - points[i - 1].y) / (points[i].y - points[i - 1].y);
      out.push_back({points[i - 1].x + t * (points[i].x - points[i - 1].x), floor});
    }
    if (points[i].y <= floor) out.push_back(points[i]);
  }
  return out;
}

void draw_band(SvgWriter& svg, const BudgetView& view, const BudgetLayout& layout) {
  std::vector<Point> upper;
  std::vector<Point> lower;
  for (const ScaleView& scale : view.scales) {
    if (!drawable(scale.upper) || !drawable(scale.measured) || !std::isfinite(scale.lower))
      continue;
    const double x = layout.time(scale.seconds);
    const double floor = layout.budget.bottom;
    const double low =
        drawable(scale.lower) ? std::min(floor, layout.variance(scale.lower)) : floor;
    upper.push_back({x, layout.variance(scale.upper)});
    lower.push_back({x, low});
  }
  for (std::size_t i = 0; i < upper.size(); ++i) svg.line("whisker", upper[i], lower[i]);
  upper.insert(upper.end(), lower.rbegin(), lower.rend());
  svg.path("band", upper, true);
}

void draw_replicates(SvgWriter& svg, const BudgetView& view, const BudgetLayout& layout) {
  if (view.replicates.size() < 2) return;
  for (const ReplicateView& replicate : view.replicates) {
    svg.path("replicate",
             curve(replicate.scales, layout, [](const ScaleView& s) { return s.measured; }));
  }
}

// Terms, their names along them, and which of them the plot cannot show.
std::string draw_terms(SvgWriter& svg, const BudgetView& view, const BudgetLayout& layout,
                       const std::vector<Point>& measured, const std::vector<Point>& model) {
  std::vector<std::vector<Point>> lines;
  std::string absent;
  for (std::size_t t = 0; t < view.terms.size(); ++t) {
    const auto line = curve(view.scales, layout, [t](const ScaleView& s) { return s.terms[t]; });
    lines.push_back(above(line, layout.budget.bottom));
    svg.path(fmt::format("term term-{} toggle-{}", t % kTermStyles, t), lines.back());
    if (lines.back().size() < 2) absent += (absent.empty() ? "" : ", ") + view.terms[t];
  }
  lines.push_back(model);
  std::vector<std::string> names;
  const std::size_t longest = layout.width < kNarrow ? 12 : 24;
  for (const std::string& name : view.terms) names.push_back(shorten(clean_text(name), longest));
  for (const CurveLabel& label : place_labels(lines, names, measured, layout.budget, kLabelSize)) {
    svg.text(fmt::format("label term-{} toggle-{}", label.curve % kTermStyles, label.curve),
             label.at, names[label.curve], kLabelSize, Anchor::kStart);
  }
  return absent;
}

// What the marks mean, in one row of mark and words.
void draw_key(SvgWriter& svg, const BudgetView& view, double left, double baseline) {
  const double y = baseline - 4.0;
  const auto words = [&](const char* text) {
    svg.text("key", {left + 24.0, baseline}, text, kTextSize, Anchor::kStart);
    left += 24.0 + text_width(text, kTextSize) + 14.0;
  };
  svg.line("whisker", {left + 9.0, y - 8.0}, {left + 9.0, y + 8.0});
  svg.circle("measured", {left + 9.0, y}, kPointRadius);
  words("measured");
  svg.line("model", {left, y}, {left + 18.0, y});
  words("model");
  if (!view.terms.empty()) {
    svg.line("term term-key", {left, y}, {left + 18.0, y});
    words("terms");
  }
  if (view.replicates.size() > 1) {
    svg.line("replicate", {left, y}, {left + 18.0, y});
    words("replicates");
  }
}

void draw_budget(SvgWriter& svg, const BudgetView& view, const BudgetLayout& layout,
                 const std::string& unit) {
  draw_time_grid(svg, layout.time, layout.budget);
  draw_variance_axes(svg, layout, unit);
  if (view.scales.empty()) {
    svg.text("note", {0.5 * (layout.budget.left + layout.budget.right), layout.budget.top + 60.0},
             "no scales to draw", kTextSize, Anchor::kMiddle);
  }
  draw_band(svg, view, layout);
  draw_replicates(svg, view, layout);
  const auto measured = curve(view.scales, layout, [](const ScaleView& s) { return s.measured; });
  const auto model = curve(view.scales, layout, [](const ScaleView& s) { return s.model; });
  const std::string absent = draw_terms(svg, view, layout, measured, model);
  svg.path("model", model);
  for (const ScaleView& scale : view.scales) {
    if (!drawable(scale.measured)) continue;
    svg.circle(scale.outside() ? "measured outside"
               : scale.tested  ? "measured"
                               : "measured untested",
               {layout.time(scale.seconds), layout.variance(scale.measured)}, kPointRadius);
  }
  if (!absent.empty()) {
    const auto columns = static_cast<std::size_t>((layout.budget.right - layout.budget.left) /
                                                  text_width("x", kNoteSize));
    svg.text("note", {layout.budget.left, layout.budget.bottom + 17.0},
             shorten(clean_text("too small to draw: " + absent), columns), kNoteSize,
             Anchor::kStart);
  }
}

// Columns under the pointer, and the line that marks the one it is in.
void draw_columns(SvgWriter& svg, const BudgetView& view, const BudgetLayout& layout) {
  const Box frame{layout.budget.left, layout.budget.top, layout.budget.right,
                  layout.residual.bottom};
  svg.line("guide", {frame.left, frame.top}, {frame.left, frame.bottom});
  for (std::size_t k = 0; k < view.scales.size(); ++k) {
    svg.rect(
        "column", column_of(view, layout.time, k, frame),
        fmt::format(R"(data-scale="{}" data-x="{:.2f}")", k, layout.time(view.scales[k].seconds)));
  }
}

}  // namespace

std::string budget_caption(const v1::FitReport& report) {
  const BudgetView view = budget_view(report);
  std::string out =
      "Haar wavelet variance ν against its averaging time 2m/f. The right-hand scale reads the "
      "same "
      "points as Allan deviation √(2ν), whose own averaging time m/f is half of the one below. ";
  if (std::isfinite(report.confidence()) && report.confidence() > 0.0) {
    out += "Shaded: " + percent(report.confidence()) + " confidence. ";
  }
  out += "Residual: measured minus model in standard deviations under the model; grey band ±2 σ.";
  const auto untested = [](const ScaleView& scale) { return !scale.tested; };
  if (std::any_of(view.scales.begin(), view.scales.end(), untested)) {
    out += " Hatched: too few degrees of freedom to test.";
  }
  return out;
}

std::string svg_opening(const SvgOptions& options, double height, const std::string& name) {
  std::string out = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" class="figure" viewBox="0 0 {0} {1:.0f}" )"
      "width=\"{0}\" height=\"{1:.0f}\" role=\"img\" aria-label=\"{2}\">\n",
      options.width, height, escape_markup(name));
  if (options.variant == SvgVariant::kStandalone) {
    out += "<style>\n" + plot_style_for_paper() + "</style>\n";
    out += "<rect class=\"paper\" x=\"0\" y=\"0\" width=\"100%\" height=\"100%\"/>\n";
  }
  return out;
}

std::string page_opening(const char* kind, double width, double height, const std::string& name) {
  return of_kind(svg_opening({SvgVariant::kInline, width, kind}, height, name), kind);
}

std::string budget_svg(const v1::FitReport& report, const SvgOptions& options) {
  const BudgetView view = budget_view(report);
  const bool paper = options.variant == SvgVariant::kStandalone;
  const double key_row = paper ? 74.0 : 18.0;
  const BudgetLayout layout = budget_layout(view, options.width, key_row + 8.0);
  const auto caption = paper ? wrap_px(budget_caption(report), kNoteSize, options.width - 8.0)
                             : std::vector<std::string>{};
  const double line_height = 1.5 * kNoteSize;
  const double caption_height =
      caption.empty() ? 0.0 : 12.0 + line_height * static_cast<double>(caption.size());

  SvgWriter svg;
  svg.raw(svg_opening(options, layout.height + caption_height,
                      "Noise budget of " + report.channel() + ": " + report.summary()));
  if (paper) {
    const auto fits = [&](const std::string& text, double size) {
      const double columns = (options.width - 8.0) / text_width("x", size);
      return shorten(clean_text(text), static_cast<std::size_t>(columns));
    };
    svg.text("title", {4.0, 22.0}, fits(channel_name(report.channel()), kTitleSize), kTitleSize,
             Anchor::kStart);
    const std::string words(verdict_words(verdict(report)));
    svg.text("subtitle", {4.0, 43.0}, fits(words + ": " + facts(report), kTextSize), kTextSize,
             Anchor::kStart);
  }
  draw_key(svg, view, 4.0, key_row);
  draw_misfits(svg, report, view, layout);
  draw_budget(svg, view, layout, report.unit());
  draw_residuals(svg, view, layout, options.id);
  for (std::size_t i = 0; i < caption.size(); ++i) {
    svg.text("note", {4.0, layout.height + 12.0 + line_height * static_cast<double>(i)}, caption[i],
             kNoteSize, Anchor::kStart);
  }
  if (!paper) draw_columns(svg, view, layout);
  svg.close("svg");
  return svg.str();
}

std::string of_kind(std::string svg, std::string_view kind) {
  constexpr std::string_view kPlain = R"(class="figure")";
  if (!svg.empty())
    svg.replace(svg.find(kPlain), kPlain.size(), fmt::format(R"(class="figure {}")", kind));
  return svg;
}

}  // namespace imunoise::report
