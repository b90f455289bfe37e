#pragma once

#include "core/regression/joint_fit.h"

namespace imunoise {

/// The current model, fitted, and what all searches look at.
struct Current {
  const Regression& regression;
  const JointFit& fit;
  std::vector<BandedPower> pooled;        ///< what the fit leaves, see pooled()
  std::vector<SharedVector> cosines;      ///< what it leaves of each replicate
  std::vector<Eigen::ArrayXd> spectrum;   ///< of the noise at these
  std::vector<Eigen::VectorXd> weighted;  ///< the inverse transform of cosines/spectrum: in time

  const Subject& subject() const { return regression.subject(); }
  /// Number of the longest replicate, the first of those: it shows all frequencies that any shows.
  std::size_t longest() const;
};
Current current_of(const Regression& regression, const JointFit& fit);

}  // namespace imunoise
