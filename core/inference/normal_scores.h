#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/estimate/estimators.h"

namespace imunoise {

/// The moments of one kind of replicate as numbers whose distribution is close to normal. The
/// measured variance of a scale with few degrees of freedom is skew, close to χ²: its cube root is
/// normal (Wilson & Hilferty 1931), itself it is not. What the scales of one octave differ by is
/// left out where it has less than a hundredth of their variance. Made from the covariance under
/// one model; other models close to it are scored with the same relative deviations and
/// correlations.
class NormalScores {
 public:
  /// `covariance` is V of the moments of `wv` under `model`, n × n. Only scales with at least 5
  /// exact equivalent degrees of freedom 2ν²/V_jj are used.
  NormalScores(const Model& model, const WaveletVariance& wv, const Eigen::MatrixXd& covariance);

  /// Scales of the replicate that are used.
  const std::vector<bool>& used() const { return used_; }
  Eigen::Index size() const { return whitening_.rows(); }

  /// Residuals of the measured variances from those that a model expects (both n), whitened.
  Eigen::VectorXd residual(const Eigen::ArrayXd& measured, const Eigen::ArrayXd& expected) const;
  /// How far those residuals move when another variance is expected instead (n): size() numbers.
  Eigen::VectorXd shift(const Eigen::ArrayXd& other, const Eigen::ArrayXd& expected) const;
  /// The same, to first order, of a change of what the model expects by each column of `change`
  /// (n × p): size() × p.
  Eigen::MatrixXd slope(const Eigen::MatrixXd& change, const Eigen::ArrayXd& expected) const;

 private:
  std::vector<bool> used_;
  std::vector<Eigen::Index> keep_;
  Eigen::ArrayXd relative_;    // n: standard deviation over expectation
  Eigen::MatrixXd whitening_;  // of the correlation of the used scales
};

/// The scores of all replicates against one model, and their projection on what its free parameters
/// (those inside their bounds) can explain: s = Aᵀz, I = AᵀA, a row a replicate.
struct ScoreBlocks {
  ScoreBlocks(const Model& model, std::span<const WaveletVariance> replicates,
              const PerReplicate<NormalScores>& scores);

  std::vector<double> squares;               ///< zᵀz
  std::vector<Eigen::Index> sizes;           ///< of z
  std::vector<Eigen::VectorXd> score;        ///< s
  std::vector<Eigen::MatrixXd> information;  ///< I
};

/// sᵀI⁻s and the rank of I: what parameters explain.
struct Explained {
  double squares = 0.0;
  Eigen::Index rank = 0;
};
Explained explained(const Eigen::VectorXd& score, const Eigen::MatrixXd& information);

/// The NormalScores of each kind of replicate under one model.
PerReplicate<NormalScores> normal_scores(const Model& model,
                                         std::span<const WaveletVariance> replicates,
                                         const MomentCovariances& covariances);

}  // namespace imunoise
