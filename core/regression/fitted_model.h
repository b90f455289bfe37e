#pragma once

#include <cmath>
#include <memory>

#include "core/effect/reported_number.h"
#include "core/regression/joint_fit.h"

namespace imunoise {

/// Noise and effects, fitted to the replicates of a subject as one model.
struct FittedModel {
  Regression regression;
  JointFit fit;
};

/// Fits a model to a subject. `start`: every value of the noise set. What must be sought in the
/// samples (outliers, jumps) is sought under the noise that the rest of the model leaves.
FittedModel fit_full_model(std::shared_ptr<const Subject> subject, const FullModel& start,
                           const Progress& progress = {});

/// A fitted model with one term more.
FittedModel fit_with(const Current& current, const EffectTerm& term);

/// A term that followed the power or the distribution of the noise before an effect was in the
/// model took part of this effect for noise. Fits all terms anew from the first samples, and
/// returns the more likely of both fits. Returns the model as it is if it has a term that fits
/// itself (a telegraph noise): such terms would change their order.
FittedModel found_anew(FittedModel model);

/// An effect of a fitted model, by its number.
struct FittedEffect {
  const FittedModel& model;
  std::size_t number;
  /// Degrees of freedom of the noise level, which is itself an estimate: Student's distribution.
  double noise_dof = INFINITY;

  const EffectTerm& term() const { return model.regression.effects()[number]; }
  const Subject& subject() const { return model.regression.subject(); }
};

/// What a fit found of an effect: coefficients, amplitudes, heights, with their intervals.
std::vector<ReportedNumber> fitted_numbers(const FittedEffect& effect);
/// Its coefficients, with their errors; a time constant is uncertain, too.
std::vector<ReportedNumber> coefficient_numbers(const FittedEffect& effect);

/// Unit of the coefficient that a fit of a term finds.
std::string unit_of(const EffectTerm& term, const Subject& subject);

/// The term with the truth that a fit found, as a simulation takes it: of a coefficient of each
/// replicate, the root mean square.
EffectTerm with_truth(const EffectTerm& term, const std::vector<ReportedNumber>& found);

}  // namespace imunoise
