#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/array/latents.h"
#include "core/wavelet/lag_sums.h"
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
/// it is moment_covariance()). It is quadratic in the powers: the sums over lags are made once for
/// each pair of distinct shapes, and serve all models that differ in their powers alone.
class ArrayMomentCovariance {
 public:
  ArrayMomentCovariance(const ArrayModel& shapes, const Scales& scales, std::size_t samples);

  /// Precondition: the model's latents have the shapes given above.
  Eigen::MatrixXd operator()(const ArrayModel& model, const Pairs& pairs) const;

 private:
  // The distinct shapes of a model that are random, and the place among them of each latent's.
  struct Shapes {
    explicit Shapes(const ArrayModel& model);
    std::vector<SumCovariance> sums;
    std::vector<std::size_t> of_latent;
  };

  Shapes shapes_;
  Scales scales_;
  LagSums sums_;
};

/// The same for one model.
Eigen::MatrixXd array_moment_covariance(const ArrayModel& model, const Pairs& pairs,
                                        const Scales& scales, std::size_t samples);

}  // namespace imunoise
