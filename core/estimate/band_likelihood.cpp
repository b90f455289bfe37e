#include "core/estimate/band_likelihood.h"

#include <cmath>
#include <limits>

namespace imunoise {
namespace {

Eigen::Index side_of(const Eigen::ArrayXXd& matrices) {
  return static_cast<Eigen::Index>(std::lround(std::sqrt(static_cast<double>(matrices.cols()))));
}

}  // namespace

// Cholesky's factors of all bands together.
BandLikelihood::BandLikelihood(const Eigen::ArrayXd& count, const Eigen::ArrayXXd& expected)
    : channels_(side_of(expected)), half_count_(0.5 * count), factor_(expected) {
  for (Eigen::Index j = 0; j < channels_; ++j) {
    Eigen::ArrayXd pivot = factor(j, j);
    for (Eigen::Index m = 0; m < j; ++m) pivot -= factor(j, m).square();
    for (Eigen::Index b = 0; b < pivot.size(); ++b) {
      if (pivot(b) > 0.0) continue;
      singular_ = true;
      half_count_(b) = 0.0;
      pivot(b) = 1.0;
    }
    factor_.col(j + j * channels_) = pivot.rsqrt();
    for (Eigen::Index i = j + 1; i < channels_; ++i) {
      auto entry = factor_.col(i + j * channels_);
      for (Eigen::Index m = 0; m < j; ++m) entry -= factor(i, m) * factor(j, m);
      entry *= factor(j, j);
    }
  }
}

Eigen::ArrayXXd BandLikelihood::whitened(Eigen::ArrayXXd of) const {
  const Eigen::Index k = channels_;
  for (Eigen::Index c = 0; c < k; ++c) {
    for (Eigen::Index i = 0; i < k; ++i) {
      auto entry = of.col(i + c * k);
      for (Eigen::Index m = 0; m < i; ++m) entry -= factor(i, m) * of.col(m + c * k);
      entry *= factor(i, i);
    }
  }
  for (Eigen::Index r = 0; r < k; ++r) {
    for (Eigen::Index i = 0; i < k; ++i) {
      auto entry = of.col(r + i * k);
      for (Eigen::Index m = 0; m < i; ++m) entry -= factor(i, m) * of.col(r + m * k);
      entry *= factor(i, i);
    }
  }
  return of;
}

double BandLikelihood::objective(const Eigen::ArrayXXd& measured) const {
  if (singular_) return std::numeric_limits<double>::infinity();
  const Eigen::ArrayXXd white = whitened(measured);
  double out = 0.0;
  for (Eigen::Index i = 0; i < channels_; ++i)
    out += (half_count_ * (white.col(i + i * channels_) - 2.0 * factor(i, i).log())).sum();
  return out;
}

Eigen::MatrixXd BandLikelihood::slopes(const std::vector<SpectralDirection>& directions) const {
  const Eigen::Index bands = factor_.rows();
  const Eigen::ArrayXd root = half_count_.sqrt();
  Eigen::MatrixXd out(factor_.size(), static_cast<Eigen::Index>(directions.size()));
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const auto& [spectrum, matrix] = directions[d];
    if (channels_ == 1) {  // the same, without matrices
      out.col(static_cast<Eigen::Index>(d)) =
          (matrix(0, 0) * root * spectrum * factor_.col(0).square()).matrix();
      continue;
    }
    const Eigen::ArrayXXd white =
        whitened(matrix.reshaped().transpose().array().replicate(bands, 1));
    out.col(static_cast<Eigen::Index>(d)) =
        (white.colwise() * (root * spectrum)).matrix().reshaped();
  }
  return out;
}

Eigen::VectorXd BandLikelihood::excess(const Eigen::ArrayXXd& measured) const {
  Eigen::ArrayXXd white = whitened(measured);
  for (Eigen::Index i = 0; i < channels_; ++i) white.col(i + i * channels_) -= 1.0;
  return (white.colwise() * half_count_.sqrt()).matrix().reshaped();
}

}  // namespace imunoise
