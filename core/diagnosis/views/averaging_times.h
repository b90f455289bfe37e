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
  TestOutcome test;         ///< of all, given that the model was fitted: test_after_fit()
};

/// `left`: left_over() of the model. Replicates may differ in length: a scale counts those that
/// have it.
AveragingTimes averaging_times(const FittedModel& fitted, const LeftOver& left);

}  // namespace imunoise
