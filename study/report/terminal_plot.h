#pragma once

#include <string>

#include "study/report/budget_view.h"
#include "study/report/terminal_canvas.h"

namespace imunoise::report {

/// Points over the model's line on logarithmic axes. With `residuals`, two rows below: digits that
/// say how many standard deviations a point lies above or below the model.
std::string terminal_plot(const BudgetView& view, bool residuals, const TerminalStyle& style);

}  // namespace imunoise::report
