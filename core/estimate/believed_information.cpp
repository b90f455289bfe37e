#include "core/estimate/believed_information.h"

#include "core/support/linear_algebra.h"

namespace imunoise {

BelievedInformation::BelievedInformation(const Eigen::MatrixXd& fisher,
                                         const Eigen::MatrixXd& correction) {
  constexpr double kSmallestShare = 0.1;
  root_ = Eigen::MatrixXd::Zero(fisher.rows(), 0);
  if (!(fisher.diagonal().array() > 0.0).any()) return;
  const Eigen::MatrixXd whitening = whiten(fisher).matrix;
  root_ = fisher * whitening.transpose();
  size_ = Eigen::VectorXd::Ones(root_.cols());
  if (correction.size() == 0) return;
  const SymmetricEigen change = symmetric_eigen(whitening * correction * whitening.transpose());
  size_ = (1.0 + change.values.array()).abs().max(kSmallestShare);
  root_ = root_ * change.vectors;
}

Eigen::MatrixXd BelievedInformation::damped(double damping) const {
  return root_ * (size_.array() + damping).matrix().asDiagonal() * root_.transpose();
}

}  // namespace imunoise
