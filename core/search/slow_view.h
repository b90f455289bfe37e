#pragma once

#include <functional>

#include "core/regression/current.h"

namespace imunoise {

/// The slow half of what the fit leaves, whitened, and regressors like it: block means instead of
/// samples, so that a shape can be tried at many time constants. Replicates lie one below the
/// other.
class SlowView {
 public:
  explicit SlowView(const Current& current);

  /// Samples that make a block of a replicate.
  Eigen::Index block(std::size_t replicate) const { return parts_[replicate].block; }
  double block_seconds(std::size_t replicate) const {
    return static_cast<double>(block(replicate)) / rate_.value;
  }
  /// The longest of any replicate: shapes must not be faster.
  double longest_block_seconds() const;
  /// Block means of a series as long as the replicate.
  Eigen::VectorXd means(const VectorRef& samples, std::size_t replicate) const;
  /// Regressors given as block means of each replicate, as they stand against the noise.
  Eigen::VectorXd whitened(const std::vector<Eigen::VectorXd>& means) const;
  /// Log-likelihood gained by a whitened regressor with one coefficient for all replicates, or one
  /// for each.
  double gain(const Eigen::VectorXd& whitened, bool own) const;

  /// What two whitened regressors explain together, a coefficient each for all replicates.
  struct Two {
    double gain = 0.0;         ///< nats
    double ratio = 0.0;        ///< coefficient of the first over that of the second,
    double ratio_error = 0.0;  ///< its standard error (to first order),
    double information = 0.0;  ///< and 1/variance of the second beside the first
  };
  /// All zero where the data cannot tell them apart.
  Two two(const Eigen::VectorXd& first, const Eigen::VectorXd& second) const;

  using Means = std::vector<Eigen::VectorXd>;
  /// The regressor of most gain among a family of time constants, finer than its grid.
  struct BestTime {
    double seconds = 0.0;
    double gain = 0.0;
    double log_error = 0.0;    ///< standard error of its logarithm
    double information = 0.0;  ///< 1/variance of the coefficient
    double path = 0.0;         ///< along the grid
  };
  BestTime best_time(double shortest_s, double longest_s, bool own,
                     const std::function<Means(double seconds)>& family) const;

 private:
  struct Part {
    Eigen::Index block;
    Eigen::Index begin;        // of its coefficients
    Eigen::ArrayXd deviation;  // of these, under the noise
  };
  Hertz rate_;
  std::vector<Part> parts_;
  Eigen::VectorXd left_;  // whitened
};

}  // namespace imunoise
