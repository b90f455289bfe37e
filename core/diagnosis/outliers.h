#pragma once

#include "core/diagnosis/scan.h"

namespace imunoise {

/// Samples that stand out from what the noise before and after them makes likely.
struct Outliers {
  std::vector<std::vector<Eigen::Index>> places;  ///< of each replicate
  std::vector<std::vector<double>> sizes;         ///< unit
  double above = 0.0;                             ///< the threshold
  double gain_nats = 0.0;                         ///< log-likelihood that taking them out gains
  std::size_t count = 0;
};

/// Those beyond `above` standard deviations of what single samples can be told by (the matched
/// filter of an impulse under the noise); of neighbours, the largest.
Outliers find_outliers(const Current& current, double above);

/// The threshold that noise of this many samples passes once in 20 recordings.
double outlier_threshold(const Subject& subject);

/// The subject with them taken out. Sizes are estimates, so the noise beneath them stays, less one
/// degree of freedom each.
std::shared_ptr<const Subject> without(const Subject& subject, const Outliers& outliers);

}  // namespace imunoise
