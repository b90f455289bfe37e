#pragma once

#include <string>

#include "study/report/budget_layout.h"
#include "study/report/svg_writer.h"

namespace imunoise::report {

/// The strip of residuals under the budget, in standard deviations.
void draw_residuals(SvgWriter& svg, const BudgetView& view, const BudgetLayout& layout,
                    const std::string& id);

/// Light columns through both panels where a model that fails the test fails.
void draw_misfits(SvgWriter& svg, const v1::FitReport& report, const BudgetView& view,
                  const BudgetLayout& layout);

}  // namespace imunoise::report
