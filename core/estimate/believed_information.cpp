#include "core/estimate/believed_information.h"

#include "core/support/linear_algebra.h"

namespace imunoise {

BelievedInformation::BelievedInformation(const Eigen::MatrixXd& fisher,
                                         const Eigen::MatrixXd& correction) {
  constexpr double kSmallestShare = 0.1;
  constexpr double kTold = 1e-11;  // as pseudo_inverse() takes it
  if (fisher.size() == 0) return;
  const Eigen::VectorXd scale = fisher.diagonal().cwiseSqrt();
  const Eigen::VectorXd unit = (scale.array() > 0.0).select(scale.cwiseInverse(), 0.0);
  const SymmetricEigen eigen = symmetric_eigen(unit.asDiagonal() * fisher * unit.asDiagonal());
  const double least = kTold * eigen.values.maxCoeff();
  const Eigen::Index rank = (eigen.values.array() > least).count();
  const Eigen::VectorXd length = eigen.values.tail(rank).cwiseSqrt();
  const Eigen::MatrixXd directions = eigen.vectors.rightCols(rank);
  root_ = scale.asDiagonal() * directions * length.asDiagonal();
  size_ = Eigen::VectorXd::Ones(rank);
  if (correction.size() == 0) return;
  const Eigen::MatrixXd whitening =
      length.cwiseInverse().asDiagonal() * directions.transpose() * unit.asDiagonal();
  const SymmetricEigen change = symmetric_eigen(whitening * correction * whitening.transpose());
  size_ = (1.0 + change.values.array()).abs().max(kSmallestShare);
  root_ = root_ * change.vectors;
}

Eigen::MatrixXd BelievedInformation::damped(double damping) const {
  return root_ * (size_.array() + damping).matrix().asDiagonal() * root_.transpose();
}

}  // namespace imunoise
