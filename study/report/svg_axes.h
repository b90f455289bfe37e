#pragma once

#include <string_view>

#include "study/report/budget_layout.h"
#include "study/report/svg_writer.h"

namespace imunoise::report {

/// Grid and labels of the left axis (wavelet variance) and labels of the right (Allan deviation).
void draw_variance_axes(SvgWriter& svg, const BudgetLayout& layout, const std::string& unit);

/// Vertical grid lines of the time axis inside a frame.
void draw_time_grid(SvgWriter& svg, const LogAxis& time, const Box& frame);

/// Labels and title of the time axis under a frame.
void draw_time_labels(SvgWriter& svg, const LogAxis& time, const Box& frame);

}  // namespace imunoise::report
