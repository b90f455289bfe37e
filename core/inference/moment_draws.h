#pragma once

#include <span>
#include <vector>

#include "core/estimate/estimators.h"
#include "core/support/random.h"

namespace imunoise {

/// Draws sets of measured moments as a model would give them, without simulating a single sample:
/// each wavelet variance is the cube of a normal number with its expectation, deviation and
/// equivalent degrees of freedom (Wilson & Hilferty 1931), correlated as its covariance says. What
/// the parametric bootstraps are made of: a set costs microseconds, whatever the recording's
/// length. Thread-safe.
class MomentDraws {
 public:
  /// `replicates` give lengths, scales and rates; `covariances` are theirs under the model.
  MomentDraws(const Model& model, std::span<const WaveletVariance> replicates,
              const MomentCovariances& covariances);

  /// One set: like the replicates, with other variances and their χ² intervals.
  std::vector<WaveletVariance> draw(RandomStream& stream) const;

 private:
  struct Distribution {
    Eigen::ArrayXd spread;  // n: 2 / (9 edof)
    Eigen::MatrixXd root;   // n × n, of the correlation
  };
  std::vector<WaveletVariance> expected_;
  PerReplicate<Distribution> distributions_;
};

}  // namespace imunoise
