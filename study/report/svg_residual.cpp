#include "study/report/svg_residual.h"

#include <fmt/format.h>

#include <cmath>

#include "study/report/svg_axes.h"
#include "study/report/verdict.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

// Pattern of scales that are shown but not tested; ids are global to a page.
std::string hatch(const std::string& id) {
  return fmt::format(
      R"(<defs><pattern id="{}-hatch" width="7" height="7" patternUnits="userSpaceOnUse" )"
      "patternTransform=\"rotate(45)\"><line class=\"hatch\" x1=\"0\" y1=\"0\" x2=\"0\" y2=\"7\"/>"
      "</pattern></defs>\n",
      id);
}

void draw_untested(SvgWriter& svg, const BudgetView& view, const BudgetLayout& layout,
                   const std::string& id) {
  for (std::size_t k = 0; k < view.scales.size(); ++k) {
    if (view.scales[k].tested) continue;
    Box box = column_of(view, layout.time, k, layout.residual);
    while (k + 1 < view.scales.size() && !view.scales[k + 1].tested) {
      box.right = column_of(view, layout.time, ++k, layout.residual).right;
    }
    svg.rect("untested-area", box, fmt::format("fill=\"url(#{}-hatch)\"", id));
  }
}

void draw_sigma_axis(SvgWriter& svg, const BudgetLayout& layout) {
  const Box& frame = layout.residual;
  svg.rect("chance",
           {frame.left, layout.sigma(kSigmaLimit), frame.right, layout.sigma(-kSigmaLimit)});
  draw_time_grid(svg, layout.time, frame);
  double previous = frame.bottom + 100.0;
  for (const double sigma : layout.sigma.ticks()) {
    const double y = layout.sigma(sigma);
    svg.line(sigma == 0.0 ? "axis" : "grid", {frame.left, y}, {frame.right, y});
    // Ticks come in pairs of both signs, outwards: where one has no room its mirror image has none.
    if (sigma > 0.0 && previous - y < kTickSize + 2.0 && sigma > kSigmaLimit) continue;
    if (sigma < 0.0 && -sigma > kSigmaLimit && layout.sigma(-sigma) != previous) continue;
    if (sigma >= 0.0) previous = y;
    const std::string label = sigma > 0.0   ? "+" + tick_label(sigma)
                              : sigma < 0.0 ? "−" + tick_label(-sigma)
                                            : "0";
    svg.text("tick", {frame.left - 8.0, y + 4.0}, label, kTickSize, Anchor::kEnd);
  }
  svg.text("axis-title", {4.0, frame.top - 13.0}, "residual, σ", kTextSize, Anchor::kStart);
}

}  // namespace

void draw_residuals(SvgWriter& svg, const BudgetView& view, const BudgetLayout& layout,
                    const std::string& id) {
  const Box& frame = layout.residual;
  svg.raw(hatch(id));
  draw_sigma_axis(svg, layout);
  draw_untested(svg, view, layout, id);
  for (const ScaleView& scale : view.scales) {
    if (!std::isfinite(scale.residual)) continue;
    const char* const kind = scale.outside() ? " outside" : scale.tested ? "" : " untested";
    const Point at{layout.time(scale.seconds), layout.sigma(scale.residual)};
    svg.line(std::string("stem") + kind, {at.x, layout.sigma(0.0)}, at);
    svg.circle(std::string("residual") + kind, at, 3.4);
  }
  draw_time_labels(svg, layout.time, frame);
}

void draw_misfits(SvgWriter& svg, const v1::FitReport& report, const BudgetView& view,
                  const BudgetLayout& layout) {
  // When the test passes, a scale beyond 2σ is the one in twenty that chance puts there.
  if (const Verdict v = verdict(report); v == Verdict::kFits || v == Verdict::kUntested) return;
  const Box both{layout.budget.left, layout.budget.top, layout.budget.right,
                 layout.residual.bottom};
  for (const Misfit& misfit : misfits(view)) {
    Box box = column_of(view, layout.time, misfit.first, both);
    box.right = column_of(view, layout.time, misfit.last, both).right;
    svg.rect("misfit", box);
  }
}

}  // namespace imunoise::report
