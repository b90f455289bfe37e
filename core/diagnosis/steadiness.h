#pragma once

#include "core/inference/goodness.h"
#include "core/regression/joint_fit.h"

namespace imunoise {

/// Is the last noise that was added to a model always there, as stationary noise is? Its smoothed
/// course (the Wiener filter of the fit) is cut into stretches, whose power must be equal but for
/// chance: χ² of their normal scores. What comes and goes (knocks, a line that wanders through,
/// noise that grows) fails here, though its mean spectrum fits.
TestOutcome steadiness(const Regression& regression, const JointFit& fit, const Process& added);

}  // namespace imunoise
