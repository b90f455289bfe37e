#pragma once

#include "core/inference/normal_scores.h"

namespace imunoise {

/// A χ² test.
struct TestOutcome {
  double statistic = 0.0;
  int degrees_of_freedom = 0;
  double p_value = 1.0;
};
TestOutcome chi_square_test(double statistic, Eigen::Index degrees_of_freedom);

/// Does the shape of the model fit all replicates? Residuals on the scale on which they are normal,
/// whitened, and taken orthogonal to what the free parameters can still explain (Rao & Robson 1974;
/// Newey 1985).
TestOutcome goodness_of_fit(const ScoreBlocks& blocks);

}  // namespace imunoise
