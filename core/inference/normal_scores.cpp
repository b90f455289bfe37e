#include "core/inference/normal_scores.h"

#include <cmath>

#include "core/inference/parameter_covariance.h"
#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

constexpr double kLeastDegreesOfFreedom = 5.0;
// Of the variance along an eigenvector of the correlations, which is 1 in the mean. Less is left of
// the differences of scales within an octave: there the small ways in which the scores are not
// normal count more than the data. Scales an octave apart have no such directions.
constexpr double kLeastVariance = 0.01;

Eigen::MatrixXd whitened(const Eigen::MatrixXd& correlation) {
  const SymmetricEigen along = symmetric_eigen(correlation);
  const auto kept = (along.values.array() >= kLeastVariance).count();
  return along.values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal() *
         along.vectors.rightCols(kept).transpose();
}

}  // namespace

NormalScores::NormalScores(const Model& model, const WaveletVariance& wv,
                           const Eigen::MatrixXd& covariance)
    : used_(wv.scales.size()) {
  const Eigen::ArrayXd nu = variance(model, wv.scales.half_widths());
  relative_ = covariance.diagonal().array().sqrt() / nu;
  for (std::size_t i = 0; i < used_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    used_[i] =
        relative_(at) > 0.0 && 2.0 / (relative_(at) * relative_(at)) >= kLeastDegreesOfFreedom;
    if (used_[i]) keep_.push_back(at);
  }
  const auto size = static_cast<Eigen::Index>(keep_.size());
  Eigen::MatrixXd correlation(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      const Eigen::Index a = keep_[static_cast<std::size_t>(i)];
      const Eigen::Index b = keep_[static_cast<std::size_t>(j)];
      correlation(i, j) = covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
    }
  }
  whitening_ = size > 0 ? whitened(correlation) : Eigen::MatrixXd(0, 0);
}

Eigen::VectorXd NormalScores::residual(const Eigen::ArrayXd& measured,
                                       const Eigen::ArrayXd& expected) const {
  Eigen::VectorXd scores(static_cast<Eigen::Index>(keep_.size()));
  for (Eigen::Index i = 0; i < scores.size(); ++i) {
    const Eigen::Index at = keep_[static_cast<std::size_t>(i)];
    const double spread = relative_(at) * relative_(at) / 9.0;  // 2 / (9 edof)
    scores(i) = (std::cbrt(measured(at) / expected(at)) - (1.0 - spread)) / std::sqrt(spread);
  }
  return whitening_ * scores;
}

Eigen::VectorXd NormalScores::shift(const Eigen::ArrayXd& other,
                                    const Eigen::ArrayXd& expected) const {
  Eigen::VectorXd scores(static_cast<Eigen::Index>(keep_.size()));
  for (Eigen::Index i = 0; i < scores.size(); ++i) {
    const Eigen::Index at = keep_[static_cast<std::size_t>(i)];
    const double spread = relative_(at) * relative_(at) / 9.0;
    scores(i) = (std::cbrt(other(at) / expected(at)) - 1.0) * (1.0 - spread) / std::sqrt(spread);
  }
  return whitening_ * scores;
}

Eigen::MatrixXd NormalScores::slope(const Eigen::MatrixXd& change,
                                    const Eigen::ArrayXd& expected) const {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(keep_.size()), change.cols());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Eigen::Index at = keep_[static_cast<std::size_t>(i)];
    rows.row(i) = change.row(at) / (relative_(at) * expected(at));
  }
  return whitening_ * rows;
}

ScoreBlocks::ScoreBlocks(const Model& model, std::span<const WaveletVariance> replicates,
                         const PerReplicate<NormalScores>& scores) {
  const std::vector<Eigen::Index> free = parameter_sets(model).interior;
  struct Expected {
    Eigen::ArrayXd variance;
    Eigen::MatrixXd slope;
    Eigen::MatrixXd information;
  };
  std::vector<Expected> expected(scores.kinds());
  for (std::size_t k = 0; k < replicates.size(); ++k) {
    Expected& at = expected[scores.kind(k)];
    if (at.variance.size() == 0) {
      const Eigen::ArrayXd m = replicates[k].scales.half_widths();
      at.variance = variance(model, m);
      at.slope = scores[k].slope(pick_columns(jacobian(model, m), free), at.variance);
      at.information = at.slope.transpose() * at.slope;
    }
    const Eigen::VectorXd z = scores[k].residual(replicates[k].variance, at.variance);
    squares.push_back(z.squaredNorm());
    sizes.push_back(z.size());
    score.emplace_back(at.slope.transpose() * z);
    information.push_back(at.information);
  }
}

Explained explained(const Eigen::VectorXd& score, const Eigen::MatrixXd& information) {
  if (score.size() == 0) return {};
  const PseudoInverse inverse = pseudo_inverse(information);
  return {score.dot(inverse.matrix * score), inverse.rank};
}

PerReplicate<NormalScores> normal_scores(const Model& model,
                                         std::span<const WaveletVariance> replicates,
                                         const MomentCovariances& covariances) {
  return PerReplicate<NormalScores>::of(replicates, [&](std::size_t k) {
    return NormalScores(model, replicates[k], covariances[k]);
  });
}

}  // namespace imunoise
