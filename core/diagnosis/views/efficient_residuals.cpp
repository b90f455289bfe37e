#include "core/diagnosis/views/efficient_residuals.h"

#include "core/support/linear_algebra.h"

namespace imunoise {

TestOutcome test_after_fit(const Eigen::VectorXd& z, const Eigen::MatrixXd& a,
                           const Eigen::MatrixXd& information) {
  constexpr double kLeastVariance = 0.1;
  const Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(z.size(), z.size()) -
                                     a * pseudo_inverse(information).matrix * a.transpose();
  const SymmetricEigen eigen = symmetric_eigen(covariance);
  const Eigen::VectorXd along = eigen.vectors.transpose() * z;
  double statistic = 0.0;
  Eigen::Index degrees = 0;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    if (eigen.values(i) < kLeastVariance) continue;
    statistic += along(i) * along(i) / eigen.values(i);
    ++degrees;
  }
  return chi_square_test(statistic, degrees);
}

}  // namespace imunoise
