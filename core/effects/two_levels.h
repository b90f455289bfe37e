#pragma once

#include "core/effect/subject.h"
#include "core/inference/goodness.h"
#include "core/regression/fitted_model.h"
#include "core/search/step_products.h"

namespace imunoise {

/// A replicate that jumps between two levels, -½ and ½.
struct TwoLevelCourse {
  double start = -0.5;                ///< the first level
  std::vector<Eigen::Index> jumps{};  ///< samples before which it jumps, rising
  double log_places = 0.0;            ///< logarithm of how many courses have as many jumps
  double log_width = 0.0;             ///< logarithm of how many of these are as good as this one
  SharedVector cosines{};             ///< its cosine_transform()
};

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

/// The courses that a term found in the replicates of a subject, one each.
struct FoundCourses final : Found {
  explicit FoundCourses(std::vector<TwoLevelCourse> found) : courses(std::move(found)) {}
  std::vector<TwoLevelCourse> courses;
};

/// Are there two levels only? What levels of their own between the jumps would explain besides, to
/// first order: 2 × nats with a degree of freedom for each jump but one. Three levels, and bumps
/// that decay, fail here, though two levels explain most of them.
TestOutcome more_levels(const FittedModel& fitted, const std::vector<TwoLevelCourse>& courses);

}  // namespace imunoise
