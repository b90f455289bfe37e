#pragma once

// What the numbers of a fit mean, in the words that the page and the terminal share.

#include <string>
#include <string_view>
#include <vector>

#include "study/report/view/budget_view.h"
#include "study/words/verdict.h"

namespace imunoise::report {

Verdict verdict(const v1::FitReport& report);
/// One sentence that says what the p-value means.
std::string verdict_sentence(const v1::FitReport& report);

/// The model and what it was fitted to: "WN + RW · angular rate · 100 Hz · 6 replicates".
std::string facts(const v1::FitReport& report);
/// " · by MuGMWM", to follow other facts; "" where none was named, as in old files.
std::string estimator_fact(const std::string& estimator);

/// The channel's name, or words in its place.
std::string channel_name(const std::string& channel);

/// Neighbouring tested scales whose residuals leave ±2σ on the same side.
struct Misfit {
  std::size_t first = 0;  ///< Index into BudgetView::scales.
  std::size_t last = 0;   ///< Inclusive.
  std::size_t worst = 0;  ///< Where the residual is largest.
};
std::vector<Misfit> misfits(const BudgetView& view);

/// "from 20 s to 82 s: measured up to 38 % above the model (+7.3 σ)".
std::string misfit_words(const BudgetView& view, const Misfit& misfit);

/// How well the data show a parameter: "seen", "at most 3e-9: record 5 times longer to see it", ...
/// The upper bound itself stands in the interval's place, see parameter_value. A shape of noise
/// that may not be there is known only if it is. `parameter` is one of the term.
std::string observability_words(const v1::Term& term, const v1::Parameter& parameter);

/// True where only the upper bound of a parameter is known.
bool only_bounded(const v1::Parameter& parameter);

}  // namespace imunoise::report
