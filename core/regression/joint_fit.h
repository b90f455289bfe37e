#pragma once

#include <optional>

#include "core/effect/full_model.h"
#include "core/estimate/whittle.h"
#include "core/regression/modulation.h"
#include "core/regression/regression.h"

namespace imunoise {

/// Noise and effects fitted as one model.
struct JointFit {
  FullModel model{};             ///< every value of the noise set
  EffectCoefficients effects{};  ///< of the effects that are regressors
  /// Of each replicate of the subject, where an effect gives it one of its own; the common one of
  /// those that did not count.
  std::vector<Model> own_noise{};
  std::vector<Modulation> modulation{};  ///< one a course of the variance, see variance_courses()
  double log_likelihood = 0.0;           ///< nats, less what does not depend on the model
  Termination termination = Termination::kConverged;
};

/// Maximum of Whittle's likelihood next to `start`, whose values are all set: coefficients by
/// generalised least squares under the noise, noise from what they leave (with the degrees of
/// freedom that they took), in turns until neither moves. `own_start`: where the noise of each
/// replicate of the subject may begin, too, if an effect gives it one of its own; see own_starts().
JointFit joint_fit(const Regression& regression, const Model& start, const Progress& progress = {},
                   Begin begin = Begin::kAnywhere, const std::vector<Model>& own_start = {});

/// Models with the terms of `start`, in which each that a fit has already begins where each
/// replicate's own noise ends. A model with one term more then explains no less than without it:
/// fits that all begin at the common noise may end in lower maxima.
std::vector<Model> own_starts(const JointFit& fit, const Model& start);

/// What the replicates that count would be, were the fit true: transformed, divided by the root of
/// the spectrum, and transformed back; less what
/// modulates their variance.
Innovations innovations(const Regression& regression, const JointFit& fit);
/// Those of one replicate.
Eigen::VectorXd innovations(const Regression& regression, const JointFit& fit,
                            std::size_t replicate);

/// The courses that the effects say the variance follows, in their order.
std::vector<VarianceCourse> variance_courses(const Regression& regression);

}  // namespace imunoise
