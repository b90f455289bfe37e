#pragma once

// Where things stand in the figures: frames and axes, without a pixel of drawing.

#include "study/report/axis.h"
#include "study/report/budget_view.h"
#include "study/report/svg_writer.h"

namespace imunoise::report {

/// Font sizes of all figures, in px.
constexpr double kTitleSize = 17.0;
constexpr double kTextSize = 12.0;
constexpr double kTickSize = 11.5;
constexpr double kNoteSize = 11.0;

/// A figure below this width is for phones: short axis titles, smaller margins.
constexpr double kNarrow = 600.0;

struct BudgetLayout {
  double width = 0.0;   ///< px, of the whole figure without its caption
  double height = 0.0;  ///< px
  Box budget;           ///< frame of the noise budget
  Box residual;         ///< frame of the residual strip; shares left and right with `budget`
  LogAxis time;         ///< averaging time, s
  LogAxis variance;     ///< unit²
  SigmaAxis sigma;
};

/// Lays out a figure `width` px wide, its drawing starting `top` px below the upper edge.
BudgetLayout budget_layout(const BudgetView& view, double width, double top);

/// Frame and time axis of the replicates' heat map, aligned with a budget of the same width.
LogAxis time_axis(const BudgetView& view, double width);

/// Left and right edges of what is half-way between a scale and its neighbours.
Box column_of(const BudgetView& view, const LogAxis& time, std::size_t scale, const Box& frame);

}  // namespace imunoise::report
