#pragma once

#include <Eigen/Core>

namespace imunoise {

/// Information for Newton's steps uphill: what was observed of a likelihood's curvature, with what
/// curves the wrong way turned round. Along the principal directions of observed against Fisher's
/// information, each gets the size of what was observed, but at least a tenth of Fisher's. Where a
/// model misses something, the observed curvature can be many times Fisher's; steps by the latter
/// then go far too far, and zigzag.
class BelievedInformation {
 public:
  /// `fisher`: n × n, positive semidefinite; what it cannot tell apart stays so. `correction`:
  /// observed less Fisher's information, n × n, or empty where that is not known.
  BelievedInformation(const Eigen::MatrixXd& fisher, const Eigen::MatrixXd& correction);

  /// With Fisher's information `damping` times more (Levenberg 1944): n × n.
  Eigen::MatrixXd damped(double damping) const;

 private:
  Eigen::MatrixXd root_;  // n × rank: a principal direction a column, scaled so that root·rootᵀ is
                          // Fisher's information
  Eigen::VectorXd size_;  // of what is believed along each
};

}  // namespace imunoise
