#include "core/array/huber_regression.h"

#include <algorithm>
#include <cmath>

#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

constexpr double kTuning = 1.345;
constexpr double kNormalOfMad = 1.482602218505602;  // 1/Φ⁻¹(3/4)
constexpr int kMostRounds = 200;
constexpr double kClose = 1e-9;

double median(Eigen::VectorXd values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Huber's weights of the residuals of one series about their median.
Eigen::VectorXd weights_of(const Eigen::VectorXd& residual) {
  const Eigen::VectorXd about = residual.array() - median(residual);
  const double spread = kNormalOfMad * median(about.cwiseAbs());
  return about.unaryExpr([&](double r) {
    return std::abs(r) <= kTuning * spread ? 1.0 : kTuning * spread / std::abs(r);
  });
}

}  // namespace

Eigen::VectorXd huber_regression(const RegressionData& data) {
  const auto count = static_cast<Eigen::Index>(data.regressors.size());
  Eigen::VectorXd out = Eigen::VectorXd::Zero(count);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(data.response.rows(), data.series());
  for (int round = 0; round < kMostRounds; ++round) {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd moment = Eigen::VectorXd::Zero(count);
    for (Eigen::Index i = 0; i < data.series(); ++i) {
      const Eigen::VectorXd w = weights.col(i);
      const auto centred = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
        return x.array() - w.dot(x) / w.sum();
      };
      Eigen::MatrixXd x(data.response.rows(), count);
      for (Eigen::Index j = 0; j < count; ++j)
        x.col(j) = centred(data.regressors[static_cast<std::size_t>(j)].col(i));
      gram += x.transpose() * w.asDiagonal() * x;
      moment += x.transpose() * w.cwiseProduct(centred(data.response.col(i)));
    }
    const Eigen::VectorXd before = out;
    out = pseudo_inverse(gram).matrix * moment;
    if (round > 0 && (out - before).cwiseAbs().maxCoeff() <= kClose * out.cwiseAbs().maxCoeff())
      break;
    const Eigen::MatrixXd residual = data.residual(out);
    for (Eigen::Index i = 0; i < data.series(); ++i) weights.col(i) = weights_of(residual.col(i));
  }
  return out;
}

}  // namespace imunoise
