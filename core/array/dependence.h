#pragma once

#include <span>
#include <vector>

#include "core/array/array_moments.h"
#include "core/inference/goodness.h"

namespace imunoise {

/// Whether two sensors share noise.
struct PairDependence {
  Pair pair;
  TestOutcome test;            ///< of no dependence at any scale
  double adjusted_p = 1.0;     ///< corrected for the number of pairs (Holm 1979)
  Eigen::ArrayXd z;            ///< cross-covariance over its standard deviation under independence
  Eigen::ArrayXd correlation;  ///< ν̂_ab / √(ν̂_aa ν̂_bb), means over replicates
};

/// Tests of independence for every pair of sensors, a < b. Under independence the measured
/// cross-covariances have mean zero and the exact covariance Σ_s c(s) γ_aa γ_bb / (M_j M_k) of the
/// model's own spectra, whatever the rest of the array does; χ² over the scales with at least ten
/// equivalent degrees of freedom, which `z` and `correlation` keep to as well. The mean at a scale
/// is over all replicates that have it, each by its degrees of freedom. The model must fit the
/// sensors' variances.
std::vector<PairDependence> dependence(const ArrayModel& model,
                                       std::span<const WaveletCovariance> replicates);

}  // namespace imunoise
