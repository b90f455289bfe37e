#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/estimate/estimators.h"
#include "core/support/linear_algebra.h"

namespace imunoise {

/// Which parameters of a fitted model the data can move. Columns follow the parameters of all
/// terms.
struct ParameterSets {
  std::vector<Eigen::Index> interior;  ///< free, and inside their bounds
  std::vector<Eigen::Index> at_zero;   ///< powers that the fit put at zero
};
ParameterSets parameter_sets(const Model& model);

/// Columns of a matrix, in the order asked for.
Eigen::MatrixXd pick_columns(const Eigen::MatrixXd& matrix,
                             const std::vector<Eigen::Index>& columns);

/// Sandwich H⁻¹BH⁻¹ of the parameters in `set`, H = Σ AᵀΩA, B = Σ AᵀΩVΩA over the replicates.
struct ParameterCovariance {
  Eigen::MatrixXd matrix;      ///< set × set
  Eigen::VectorXd null_share;  ///< near 1 where a parameter cannot be told from the others
};
ParameterCovariance parameter_covariance(const Model& model,
                                         std::span<const WaveletVariance> replicates,
                                         const std::vector<Eigen::MatrixXd>& weight_roots,
                                         const MomentCovariances& covariances,
                                         const std::vector<Eigen::Index>& set);

/// The model with one of its powers (by its column) worth `value`.
Model with_power(Model model, Eigen::Index column, double value);

/// Standard error of the parameter of a column, when it is estimated together with those of
/// `interior`; infinite when it cannot be told from them.
double error_among(
    std::vector<Eigen::Index> interior, Eigen::Index column,
    const std::function<ParameterCovariance(const std::vector<Eigen::Index>&)>& covariance_of);

}  // namespace imunoise
