#pragma once

#include "core/diagnosis/candidates.h"
#include "core/diagnosis/step_products.h"
#include "core/inference/goodness.h"

namespace imunoise {

/// Courses between two levels, the same two in all replicates: random telegraph noise with so few
/// jumps that their times can be told.
struct TwoLevels {
  std::vector<TwoLevelCourse> courses;  ///< one a replicate
  double height = 0.0;                  ///< between the levels, unit
  double gain_nats = 0.0;               ///< that taking them out gains under the noise
  std::size_t jumps = 0;                ///< of all replicates
};

/// What courses pay for having been sought, nats: for their times, and for how many jumps they
/// have.
double log_places(const std::vector<TwoLevelCourse>& courses);

/// The courses that explain what a fit leaves, each jump being worth its price: found by flipping
/// one stretch after the other, on a grid of times.
TwoLevels find_two_levels(const std::vector<StepProducts>& replicates);

/// A fit with the effect `telegraph` more. The courses are sought under the noise of the fit, and
/// again under that which they leave: noise that took their place hides them.
Trial with_two_levels(const Regression& regression, const JointFit& fit);

/// Has a fit with `telegraph` two levels only? What levels of their own between the jumps would
/// explain besides, to first order: 2 × nats with a degree of freedom for each jump but one. Three
/// levels, and bumps that decay, fail here, though two levels explain most of them.
TestOutcome more_levels(const Trial& trial);

}  // namespace imunoise
