#include "study/report/budget_layout.h"

#include <algorithm>
#include <cmath>

namespace imunoise::report {
namespace {

struct Margins {
  double left;
  double right;
};

Margins margins(double width) {
  return width < kNarrow ? Margins{46.0, 44.0} : Margins{62.0, 62.0};
}

// Measured points, model and replicates decide what is seen; a term may leave through the floor.
LogAxis variance_axis(const BudgetView& view, double bottom, double top) {
  LogRange seen;
  for (const ScaleView& scale : view.scales) {
    seen.include(scale.measured);
    seen.include(scale.model);
    seen.include(scale.upper);
  }
  for (const ReplicateView& replicate : view.replicates) {
    for (const ScaleView& scale : replicate.scales) seen.include(scale.measured);
  }
  if (seen.empty()) return {1.0, 10.0, bottom, top};
  return {seen.low() / 4.0, seen.high() * 2.5, bottom, top};
}

SigmaAxis sigma_axis(const BudgetView& view, const Box& frame) {
  double reach = 4.0;
  for (const ScaleView& scale : view.scales) {
    if (std::isfinite(scale.residual)) reach = std::max(reach, 1.15 * std::abs(scale.residual));
  }
  return {reach, 0.5 * (frame.top + frame.bottom), 0.5 * (frame.bottom - frame.top)};
}

}  // namespace

LogAxis time_axis(const BudgetView& view, double width) {
  LogRange seen;
  for (const ScaleView& scale : view.scales) seen.include(scale.seconds);
  for (const ReplicateView& replicate : view.replicates) {
    for (const ScaleView& scale : replicate.scales) seen.include(scale.seconds);
  }
  const Margins margin = margins(width);
  if (seen.empty()) return {1.0, 10.0, margin.left, width - margin.right};
  // Room on the right for the names at the ends of the curves.
  return {seen.low() / 1.5, seen.high() * 2.5, margin.left, width - margin.right};
}

BudgetLayout budget_layout(const BudgetView& view, double width, double top) {
  const bool narrow = width < kNarrow;
  const Margins margin = margins(width);
  const double axis_titles = 30.0;
  const double budget_height = narrow ? 300.0 : 400.0;
  const double gap = 44.0;
  const double strip_height = narrow ? 96.0 : 120.0;
  const double time_labels = 46.0;

  Box budget{margin.left, top + axis_titles, width - margin.right, 0.0};
  budget.bottom = budget.top + budget_height;
  const Box strip{budget.left, budget.bottom + gap, budget.right,
                  budget.bottom + gap + strip_height};
  return {width,
          strip.bottom + time_labels,
          budget,
          strip,
          time_axis(view, width),
          variance_axis(view, budget.bottom, budget.top),
          sigma_axis(view, strip)};
}

Box column_of(const BudgetView& view, const LogAxis& time, std::size_t scale, const Box& frame) {
  const auto middle = [&](std::size_t a, std::size_t b) {
    return 0.5 * (time(view.scales[a].seconds) + time(view.scales[b].seconds));
  };
  const bool first = scale == 0;
  const bool last = scale + 1 == view.scales.size();
  return {first ? frame.left : middle(scale - 1, scale), frame.top,
          last ? frame.right : middle(scale, scale + 1), frame.bottom};
}

}  // namespace imunoise::report
