#pragma once

#include "study/figure/figure.h"
#include "study/report/view/budget_view.h"

namespace imunoise::report {

/// What a noise budget is called and how it is read, beside its numbers.
struct BudgetWords {
  std::string channel{};
  std::string unit{};
  std::string subtitle{};
  double confidence = 0.0;    ///< of the intervals; 0 where it is not known
  bool mark_misfits = false;  ///< a test says that the model fails: mark where
  bool allan = false;         ///< the view holds Allan deviations (as_allan())
  bool si = false;            ///< Allan deviations are in `unit`, not in that of data sheets
};

/// Wavelet variance over averaging time: measured with intervals, model, its terms, replicates and
/// a ghost; below it the residuals in standard deviations, where there are any. The right-hand axis
/// reads Allan deviation. Of Allan deviations: the same, without a right-hand axis.
figure::Figure budget_figure(const BudgetView& view, const BudgetWords& words);
figure::Figure budget_figure(const v1::FitReport& report);

/// The residuals of each replicate: one row a replicate, one cell a scale. Nothing without
/// replicates.
std::optional<figure::Figure> replicates_figure(const std::vector<ReplicateView>& replicates,
                                                const std::string& channel);

}  // namespace imunoise::report
