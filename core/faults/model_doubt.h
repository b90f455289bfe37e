#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "core/array/array_estimate.h"
#include "core/faults/innovations.h"

namespace imunoise {

/// Uncertainty of a fitted model. A variance that it predicts is known as well as that of ν
/// independent samples: ν = 2 over the variance of its logarithm, by the covariance of the fit's
/// parameters (Satterthwaite 1946).
class ModelDoubt {
 public:
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  ModelDoubt() = default;  ///< of a model that is the truth
  /// `readings`: number of readings of each sensor in the training. A fit that cannot tell its
  /// processes apart has large standard errors, but still matches the blocks that it saw: they give
  /// a lower bound of ν.
  ModelDoubt(const ArrayFit& fit, double readings);

  /// ν of the variance of Σ_j outputs_j · innovation_j, innovations newest first: of the row of
  /// `outputs` (rows × r·count) that is known least, a quarter of the blocks that were seen at
  /// least; kNone where the model is the truth.
  double degrees(const InnovationFilter& filter, const Eigen::MatrixXd& outputs) const;

 private:
  // Two models beside the fit's, which differ in one parameter.
  struct Direction {
    ArrayModel below;
    ArrayModel above;
    double distance = 0.0;
  };

  ArrayModel model_;
  double readings_ = 0.0;
  std::vector<Direction> directions_;  // one a parameter
  Eigen::MatrixXd covariance_;         // of the parameters
};

}  // namespace imunoise
