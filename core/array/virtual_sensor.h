#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/array/array_moments.h"
#include "core/support/linear_algebra.h"

namespace imunoise {

/// What the weights of a virtual sensor must satisfy.
enum class WeightRule {
  kUnitGain,     ///< Σ c = 1
  kNonnegative,  ///< Σ c = 1, c ≥ 0
  /// Σ |c| = 1, as published (Zhang et al.): the gain Σ c is not 1 then, and what it gains in noise
  /// it may lose in signal. Found exactly for up to 16 sensors, else by exchanging signs one by
  /// one.
  kUnitLength,
};

/// A virtual sensor Σ c_i y_i of an array.
struct VirtualSensor {
  Eigen::VectorXd weights;
  double gain = 1.0;      ///< Σ c: what a motion that all sensors see is multiplied with
  double variance = 0.0;  ///< cᵀ G c, the weighted wavelet variance that was minimised
};

/// G = Σ_j w_j Γ_j of wavelet cross-covariances, one I × I matrix a scale, by the fitted model or
/// as measured.
Eigen::MatrixXd weighted_covariance(const std::vector<Eigen::MatrixXd>& covariance,
                                    const Eigen::VectorXd& scale_weights);

/// The weights that minimise Σ_j w_j ν_j(c) = cᵀGc under the rule.
VirtualSensor best_virtual_sensor(const MatrixRef& weighted, WeightRule rule);

/// Covariance of the weights when the moments that G was made of are uncertain, to first order
/// (weights at zero stay there). `moments` is the covariance of moments_of(Γ, all_pairs(I)).
/// Precondition: not kUnitLength.
Eigen::MatrixXd weight_covariance(const VirtualSensor& sensor, const MatrixRef& weighted,
                                  const Eigen::VectorXd& scale_weights,
                                  const Eigen::MatrixXd& moments);

/// r_j = ν_j(c) / ν_j(equal weights), one a scale: below 1 where the weights beat the mean;
/// 1 where the mean has no noise.
Eigen::ArrayXd gain_over_mean(const std::vector<Eigen::MatrixXd>& covariance,
                              const Eigen::VectorXd& weights);

}  // namespace imunoise
