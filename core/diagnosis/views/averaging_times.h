#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/diagnosis/views/left_over.h"
#include "core/inference/goodness.h"
#include "core/model/model.h"

namespace imunoise {

/// The Allan deviation of all replicates together against a model's.
struct AveragingTimes {
  Eigen::ArrayXd seconds;   ///< averaging times with at least 5 degrees of freedom
  Eigen::ArrayXd ratio;     ///< measured variance over the model's
  Eigen::ArrayXd relative;  ///< standard error of the Allan deviation over the model's
  TestOutcome test;         ///< of all, orthogonal to what the model's parameters can explain
};

/// `left`: left_over() of a model with this noise. Replicates may differ in length: a scale counts
/// those that have it.
AveragingTimes averaging_times(const Model& noise, const LeftOver& left);

}  // namespace imunoise
