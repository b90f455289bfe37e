#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/report/budget_layout.h"
#include "study/report/heat_map.h"
#include "study/report/svg_axes.h"
#include "study/report/svg_plot.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr double kRow = 22.0;      // px
constexpr double kNameRow = 16.0;  // px, above a row, where a phone has no room beside it
constexpr double kGap = 2.0;       // px between cells

void draw_row(SvgWriter& svg, const ReplicateView& replicate, const LogAxis& time,
              const Box& frame) {
  BudgetView row;
  row.scales = replicate.scales;
  for (std::size_t k = 0; k < row.scales.size(); ++k) {
    const double residual = row.scales[k].residual;
    if (!std::isfinite(residual)) continue;
    Box box = column_of(row, time, k, frame);
    // The outer cells reach as far beyond their scale as on its inner side.
    const double x = time(row.scales[k].seconds);
    if (row.scales.size() > 1) {
      if (k == 0) box.left = std::max(frame.left, 2.0 * x - box.right);
      if (k + 1 == row.scales.size()) box.right = std::min(frame.right, 2.0 * x - box.left);
    }
    const double gap = std::min(kGap, 0.2 * (box.right - box.left));
    box.right -= gap;
    svg.rect(cell_class(residual), box);
    const double width = box.right - box.left;
    if (std::abs(residual) > kSigmaLimit && width > 7.0) {
      const std::string mark =
          width > 26.0 ? signed_sigma(residual, Digits::kTypeset) : (residual > 0.0 ? "+" : "−");
      svg.text("cell-mark", {0.5 * (box.left + box.right), box.bottom - 6.0}, mark, 10.0,
               Anchor::kMiddle);
    }
  }
}

}  // namespace

std::string replicates_svg(const v1::FitReport& report, const SvgOptions& options) {
  const BudgetView view = budget_view(report);
  if (view.replicates.empty()) return {};
  const LogAxis time = time_axis(view, options.width);
  const double pitch = kRow + kNameRow + 6.0;
  const double bottom = pitch * static_cast<double>(view.replicates.size()) + 4.0;

  SvgWriter svg;
  svg.raw(svg_opening(options, bottom + 46.0,
                      "Residual of each replicate of " + report.channel() + " at each scale"));
  const Box all{time.begin(), 0.0, time.end(), bottom};
  for (std::size_t r = 0; r < view.replicates.size(); ++r) {
    const ReplicateView& replicate = view.replicates[r];
    const double top = pitch * static_cast<double>(r) + kNameRow;
    const auto columns =
        static_cast<std::size_t>(0.6 * (all.right - all.left) / text_width("x", kNoteSize));
    svg.text("key", {all.left, top - 5.0}, shorten(clean_text(replicate.name), columns), kNoteSize,
             Anchor::kStart);
    svg.text("note", {all.right, top - 5.0},
             count(replicate.samples, Digits::kTypeset) + " samples", kNoteSize, Anchor::kEnd);
    draw_row(svg, replicate, time, {all.left, top, all.right, top + kRow});
  }
  draw_time_labels(svg, time, all);
  svg.close("svg");
  return svg.str();
}

}  // namespace imunoise::report
