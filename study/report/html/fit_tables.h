#pragma once

// The page's tables; each returns "" when the report has nothing to put in it.

#include <string>

#include "study/report/view/budget_view.h"

namespace imunoise::report {

std::string parameter_table(const v1::FitReport& report);
std::string coefficient_table(const v1::FitReport& report);
/// The three quantities that are called bias instability.
std::string bias_instability_table(const v1::FitReport& report);
/// What was fitted of the model's effects.
std::string fitted_effect_table(const v1::FitReport& report);

/// Every scale's numbers: what the pointer reads, and what a screen reader reads instead of the
/// figure.
std::string scale_table(const v1::FitReport& report, const BudgetView& view);

std::string provenance(const v1::FitReport& report);

}  // namespace imunoise::report
