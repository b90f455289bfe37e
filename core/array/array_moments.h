#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/array/latents.h"
#include "core/wavelet/wavelet_covariance.h"

namespace imunoise {

/// Two sensors, a ≤ b.
struct Pair {
  Eigen::Index a;
  Eigen::Index b;
};
using Pairs = std::vector<Pair>;

/// All pairs of sensors, each with itself too, or only each with itself.
Pairs all_pairs(Eigen::Index sensors);
Pairs own_pairs(Eigen::Index sensors);

/// The moments of some pairs in one vector, pair after pair, scales within.
Eigen::VectorXd moments_of(const std::vector<Eigen::MatrixXd>& covariance, const Pairs& pairs);

/// Exact covariance of the measured moments of pairs of Gaussian sensors, T samples each:
///   Cov(ν̂_ab(j), ν̂_cd(k)) = Σ_s c(s) [γ_ac γ_bd + γ_ad γ_bc](s) / (M_j M_k),
/// with four more terms of the products of means under ramps (Isserlis' theorem; for a = b = c = d
/// it is moment_covariance()). The model is quadratic in the powers, so the sums over lags are made
/// once for each pair of distinct shapes.
Eigen::MatrixXd array_moment_covariance(const ArrayModel& model, const Pairs& pairs,
                                        const Scales& scales, std::size_t samples);

}  // namespace imunoise
