#include "core/diagnosis/views/averaging_times.h"

#include <algorithm>
#include <cmath>

#include "core/diagnosis/views/efficient_residuals.h"
#include "core/diagnosis/views/normal_power.h"
#include "core/inference/parameter_covariance.h"
#include "core/regression/fitted_model.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr double kFewestDegrees = 5.0;

// The scales of the longest replicate: octaves, so that all others have the first of them.
const Scales& longest_scales(const std::vector<WaveletVariance>& replicates) {
  return std::max_element(
             replicates.begin(), replicates.end(),
             [](const auto& a, const auto& b) { return a.scales.size() < b.scales.size(); })
      ->scales;
}

// Mean of the replicates' variances over the model's, weighted by their coefficients, with its
// covariance. A replicate with noise of its own is compared with that; what correlates its scales
// is the noise that all share.
struct PooledRatio {
  Eigen::ArrayXd ratio;
  Eigen::MatrixXd covariance;
};

PooledRatio pooled_ratio(const FittedModel& fitted, const LeftOver& left,
                         const Eigen::ArrayXd& expected) {
  const std::vector<Model>& noise = fitted.fit.own_noise;
  const Index n = expected.size();
  Eigen::ArrayXd weights = Eigen::ArrayXd::Zero(n);
  PooledRatio out{Eigen::ArrayXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
  for (std::size_t k = 0; k < left.variances.size(); ++k) {
    const WaveletVariance& own = left.variances[k];
    const auto size = static_cast<Index>(own.scales.size());
    const Eigen::ArrayXd m = own.scales.half_widths();
    const Eigen::ArrayXd weight = static_cast<double>(own.samples) + 1.0 - 2.0 * m;
    const Eigen::ArrayXd relative = weight / expected.head(size);
    weights.head(size) += weight;
    const Eigen::ArrayXd under = noise.empty() ? expected.head(size).eval() : variance(noise[k], m);
    out.ratio.head(size) += weight * own.variance / under;
    out.covariance.topLeftCorner(size, size) +=
        relative.matrix().asDiagonal() * left.covariances[k] * relative.matrix().asDiagonal();
  }
  out.ratio /= weights;
  const Eigen::VectorXd inverse = weights.inverse().matrix();
  out.covariance = inverse.asDiagonal() * out.covariance * inverse.asDiagonal();
  return out;
}

// Fisher's information of the fit on some parameters of its noise.
Eigen::MatrixXd information_of(const FittedModel& fitted, const std::vector<Index>& interior) {
  const Regression& regression = fitted.regression;
  return whittle_information(fitted.fit.model.noise,
                             pooled(regression.residual(fitted.fit.effects.value)), interior);
}

}  // namespace

AveragingTimes averaging_times(const FittedModel& fitted, const LeftOver& left) {
  const Model& noise = fitted.fit.model.noise;
  const std::vector<Index> interior = parameter_sets(noise).interior;
  const Scales& scales = longest_scales(left.variances);
  const Eigen::ArrayXd m = scales.half_widths();
  const Eigen::ArrayXd expected = variance(noise, m);
  const PooledRatio pooled = pooled_ratio(fitted, left, expected);
  std::vector<Index> used;
  for (Index i = 0; i < m.size(); ++i) {
    if (2.0 / pooled.covariance(i, i) >= kFewestDegrees) used.push_back(i);
  }
  const auto n = static_cast<Index>(used.size());
  const Eigen::MatrixXd slopes = pick_columns(jacobian(noise, m), interior);
  AveragingTimes out{Eigen::ArrayXd(n), Eigen::ArrayXd(n), Eigen::ArrayXd(n), {}};
  Eigen::VectorXd z(n);
  Eigen::MatrixXd a(n, slopes.cols());
  Eigen::MatrixXd correlation(n, n);
  for (Index i = 0; i < n; ++i) {
    const Index at = used[static_cast<std::size_t>(i)];
    const double spread = std::sqrt(pooled.covariance(at, at));
    out.seconds(i) = 2.0 * m(at) / left.variances.front().rate.value;
    out.ratio(i) = pooled.ratio(at);
    out.relative(i) = 0.5 * spread;
    z(i) = normal_score(pooled.ratio(at), 2.0 / (spread * spread));
    a.row(i) = slopes.row(at) / (spread * expected(at));
    for (Index j = 0; j < n; ++j) {
      const Index other = used[static_cast<std::size_t>(j)];
      correlation(i, j) =
          pooled.covariance(at, other) / (spread * std::sqrt(pooled.covariance(other, other)));
    }
  }
  if (n == 0) return out;
  const Eigen::MatrixXd whitening = whiten(correlation).matrix;
  z = whitening * z;
  a = whitening * a;
  // Noise that each replicate has of its own is not what was fitted to all.
  const bool shared = fitted.fit.own_noise.empty();
  out.test = test_after_fit(z, a, shared ? information_of(fitted, interior) : a.transpose() * a);
  return out;
}

}  // namespace imunoise
