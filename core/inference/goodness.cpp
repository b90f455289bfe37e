#include "core/inference/goodness.h"

#include <cmath>

#include "core/inference/parameter_covariance.h"
#include "core/support/distributions.h"

namespace imunoise {
namespace {

constexpr double kLeastDegreesOfFreedom = 5.0;

std::vector<Eigen::Index> indices_of(const std::vector<bool>& keep) {
  std::vector<Eigen::Index> out;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (keep[i]) out.push_back(static_cast<Eigen::Index>(i));
  }
  return out;
}

// The measured variance of a scale as a standard normal number. Where degrees of freedom are few it
// is skew, close to chi-square: its cube root is normal (Wilson & Hilferty 1931), itself it is not.
double normal_score(double measured, double expected, double deviation) {
  const double relative = deviation / expected;
  const double spread = relative * relative / 9.0;  // 2 / (9 edof)
  return (std::cbrt(measured / expected) - (1.0 - spread)) / std::sqrt(spread);
}

}  // namespace

std::vector<bool> tested_scales(const Model& model, const WaveletVariance& wv,
                                const Eigen::MatrixXd& covariance) {
  const Eigen::ArrayXd nu = variance(model, wv.scales.half_widths());
  std::vector<bool> out(wv.scales.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    out[i] = covariance(at, at) > 0.0 &&
             2.0 * nu(at) * nu(at) / covariance(at, at) >= kLeastDegreesOfFreedom;
  }
  return out;
}

GoodnessOfFit goodness_of_fit(const Model& model, std::span<const WaveletVariance> replicates,
                              const PerReplicate& covariances,
                              const std::vector<std::vector<bool>>& tested) {
  const std::vector<Eigen::Index> free = parameter_sets(model).interior;
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd score = Eigen::VectorXd::Zero(n);
  double total = 0.0;
  Eigen::Index rows = 0;
  for (std::size_t k = 0; k < replicates.size(); ++k) {
    const std::vector<Eigen::Index> keep = indices_of(tested[k]);
    const auto size = static_cast<Eigen::Index>(keep.size());
    if (size == 0) continue;
    const Eigen::ArrayXd m = replicates[k].scales.half_widths();
    const Eigen::MatrixXd slope_all = pick_columns(jacobian(model, m), free);
    const Eigen::ArrayXd nu = variance(model, m);
    const Eigen::ArrayXd deviation = covariances[k].diagonal().array().sqrt();
    Eigen::VectorXd residual(size);
    Eigen::MatrixXd slope(size, n);
    Eigen::MatrixXd spread(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      const Eigen::Index at = keep[static_cast<std::size_t>(i)];
      residual(i) = normal_score(replicates[k].variance(at), nu(at), deviation(at));
      slope.row(i) = slope_all.row(at) / deviation(at);
      for (Eigen::Index j = 0; j < size; ++j) {
        const Eigen::Index other = keep[static_cast<std::size_t>(j)];
        spread(i, j) = covariances[k](at, other) / (deviation(at) * deviation(other));
      }
    }
    const Whitening white = whiten(spread);
    residual = (white.matrix * residual).eval();
    slope = (white.matrix * slope).eval();
    total += residual.squaredNorm();
    score += slope.transpose() * residual;
    information += slope.transpose() * slope;
    rows += residual.size();
  }
  const PseudoInverse inverse = pseudo_inverse(information);
  GoodnessOfFit out;
  out.statistic = n > 0 ? total - score.dot(inverse.matrix * score) : total;
  out.degrees_of_freedom = static_cast<int>(rows - inverse.rank);
  out.p_value = chi_square_tail(std::max(0.0, out.statistic), out.degrees_of_freedom);
  return out;
}

}  // namespace imunoise
