#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "core/array/array_estimate.h"
#include "core/faults/innovations.h"

namespace imunoise {

/// How far off a fitted model may be. A variance that it predicts is known as well as that of ν
/// independent samples: ν = 2 over the variance of its logarithm, by the covariance of the fit's
/// parameters (Satterthwaite 1946).
class ModelDoubt {
 public:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  ModelDoubt() = default;  ///< of a model that is the truth
  explicit ModelDoubt(const ArrayFit& fit);

  /// ν of the variance of Σ_j outputs_j · innovation_j, innovations newest first: of the row of
  /// `outputs` (rows × r·count) that is known least; kNone where the model is the truth.
  double degrees(const InnovationFilter& filter, const Eigen::MatrixXd& outputs) const;

 private:
  // A small part of a standard error away from the first, in independent directions.
  std::vector<ArrayModel> models_;
};

}  // namespace imunoise
