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

/// Covariance of some estimated parameters.
struct ParameterCovariance {
  Eigen::MatrixXd matrix;      ///< parameters × parameters
  Eigen::VectorXd null_share;  ///< near 1 where a parameter cannot be told from the others

  /// Too much of a parameter can be imitated by the others for its error to mean anything.
  bool hidden(Eigen::Index parameter) const { return null_share(parameter) > 0.2; }
  /// Standard error of a parameter; infinite where it is hidden.
  double standard_error(Eigen::Index parameter) const;
};

/// The one covariance of minimum-distance estimates, of a signal, of an array or over a covariate:
/// H⁻¹BH⁻¹ with H = Σ AᵀΩA, B = Σ AᵀΩVΩA over blocks of moments.
class Sandwich {
 public:
  explicit Sandwich(Eigen::Index parameters);
  /// A block of n moments: Ω = rootᵀ·root, A = d moments / d parameters (n × parameters), V their
  /// covariance (n × n).
  void add(const Eigen::MatrixXd& weight_root, const Eigen::MatrixXd& jacobian,
           const Eigen::MatrixXd& covariance);
  ParameterCovariance covariance() const;

 private:
  Eigen::MatrixXd bread_;  // H
  Eigen::MatrixXd meat_;   // B
};

/// The covariance of maximum-likelihood estimates: the inverse of Fisher's information.
ParameterCovariance inverse_information(const Eigen::MatrixXd& information);

/// Sandwich of the parameters in `set` from the moments of replicates.
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
