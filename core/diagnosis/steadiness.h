#pragma once

#include "core/inference/goodness.h"
#include "core/regression/joint_fit.h"

namespace imunoise {

/// Is the last noise that was added to a model always there, as stationary noise is? Its smoothed
/// course (the Wiener filter of the fit) is cut into stretches, whose power must be equal but for
/// chance: χ² of their normal scores. What comes and goes (knocks, a line that wanders through,
/// noise that grows) fails here, though its mean spectrum fits.
TestOutcome steadiness(const Regression& regression, const JointFit& fit, const Process& added);

/// Is the last noise that was added a few lines (a wave that beats, several machines) rather than
/// noise? At the frequencies where it is most of the power, squares over the fitted spectrum are χ²
/// of one degree of freedom under noise; lines make few of them large: their mean square lies 6
/// standard errors above 3.
bool made_of_lines(const Regression& regression, const JointFit& fit, const Process& added);

}  // namespace imunoise
