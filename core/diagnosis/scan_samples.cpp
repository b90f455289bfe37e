#include <cmath>

#include "core/diagnosis/outliers.h"
#include "core/diagnosis/scan.h"
#include "core/inference/parameter_covariance.h"

namespace imunoise {
namespace {

// Powers that could differ between replicates.
double free_powers(const Model& noise) {
  double out = 0.0;
  for (const Term& term : noise.terms) {
    if (!term.given[0] && values(term.process)[0] > 0.0) ++out;
  }
  return out;
}

}  // namespace

Suggestions scan_samples(const Current& current) {
  const Subject& subject = current.subject();
  Suggestions out;
  const double above = outlier_threshold(subject);
  if (const Outliers found = find_outliers(current, above); found.count > 0) {
    double samples = 0.0;
    for (const SharedVector& x : subject.samples) samples += static_cast<double>(x.size());
    const auto count = static_cast<double>(found.count);
    // So many places out of all samples: about log(samples^count / count!).
    out.push_back({.effect = "outliers",
                   .added = EffectTerm{.kind = EffectKind::kOutliers, .above = above},
                   .score_nats = found.gain_nats,
                   .dof = count,
                   .search = {.log_places = count * std::log(samples) - std::lgamma(count + 1.0) +
                                            log_number(count)}});
  }
  // What modulates the noise has made it differ between replicates, and the likelihood of their
  // powers does not know.
  const bool modulated = !current.fit.modulation.empty();
  if (subject.replicates() > 1 && current.fit.own_powers.empty() && !modulated) {
    const double dof =
        (static_cast<double>(subject.replicates()) - 1.0) * free_powers(current.fit.model.noise);
    const EffectTerm own{.kind = EffectKind::kOwnPowers};
    const JointFit apart = joint_fit(current.regression.with(own), current.fit.model.noise);
    out.push_back({.effect = "replicate_change",
                   .added = own,
                   .score_nats = apart.log_likelihood - current.fit.log_likelihood,
                   .dof = dof});
  }
  return out;
}

}  // namespace imunoise
