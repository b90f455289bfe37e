#include "study/analysis/rung_picture.h"

#include "study/analysis/comparison.h"
#include "study/analysis/diagnosis_report.h"
#include "study/analysis/measure.h"
#include "study/analysis/vocabulary.h"

namespace imunoise::study {

v1::RungPicture picture_of(const FittedModel& trial, const LeftOver& left,
                           const std::string& channel, const std::vector<std::string>& replicates) {
  v1::RungPicture out;
  *out.mutable_budget() = budget_of(trial, left);
  *out.mutable_compared() = comparison_of(trial, left, channel, replicates);
  const Model& noise = trial.fit.model.noise;
  const WaveletVariance total = pooled(left.variances);
  const Eigen::ArrayXd m = total.scales.half_widths();
  for (std::size_t t = 0; t < noise.terms.size(); ++t) {
    *out.add_terms() = term_message(noise, t, trial.regression.subject().quantity, total.rate, m);
  }
  return out;
}

}  // namespace imunoise::study
