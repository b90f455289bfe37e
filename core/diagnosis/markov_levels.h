#pragma once

#include "core/regression/joint_fit.h"

namespace imunoise {

/// Log-likelihood that two levels gain over a normal distribution for the last Markov process of a
/// fitted model, nats: of its smoothed course, taken once in two correlation times. Telegraph noise
/// has the spectrum of a Markov process; only its levels tell it apart. 0 where there is none, or
/// where the other noise hides it.
double two_level_gain(const Regression& regression, const JointFit& fit);

}  // namespace imunoise
