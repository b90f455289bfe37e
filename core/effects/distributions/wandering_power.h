#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "core/regression/modulation.h"
#include "core/support/units.h"

namespace imunoise {

/// Noise whose power wanders: its logarithm is a Markov process (stochastic volatility; Taylor
/// 1982). A hidden Markov model on a grid of powers (Kitagawa 1987, J. Amer. Stat. Assoc. 82:1032),
/// over stretches so short that the power hardly moves within them.
class WanderingPower {
 public:
  /// The fit of most likelihood of this correlation time (s); without gain where a replicate is
  /// silent. `rate`: of the innovations.
  static WanderingPower of(const Innovations& innovations, Hertz rate, double tau);
  /// The same of any correlation time; the search begins at this one.
  static WanderingPower from(const Innovations& innovations, Hertz rate, double tau);

  double gain() const { return gain_; }  ///< nats over one power in each replicate
  double tau_s() const { return tau_ / rate_; }
  /// Standard deviation of the logarithm of the power,
  double deviation() const { return deviation_; }
  /// and the standard error of its logarithm; infinite where the likelihood has no peak.
  double deviation_error() const { return deviation_error_; }
  /// Kurtosis of what has this power, over that of normal numbers.
  double kurtosis_ratio() const { return std::exp(deviation_ * deviation_); }

  struct Evened {
    /// Turns each innovation of a replicate into a normal number of the power in the middle, at the
    /// mean of the logarithm: the number with the same tail probability, given all earlier
    /// innovations (Rosenblatt 1952, Ann. Math. Stat. 23:470).
    Eigen::ArrayXd factor;
    double nats = 0.0;  ///< gained in this replicate
  };
  Evened evened(const Eigen::VectorXd& white) const;

 private:
  static WanderingPower begun(const Innovations& innovations, Hertz rate, double tau, bool any_tau);
  // `wanted`: stretches.
  void sample(const Innovations& innovations, Eigen::Index wanted);
  double objective() const;  // nats of what was sampled
  // `longest`: the longest correlation time (samples); 0: it is known.
  void climb(const Innovations& innovations, int from, int rounds, double longest);
  void settle(bool any_tau);
  double level_in(const Eigen::VectorXd& white) const;

  double rate_ = 1.0;
  double tau_ = 1.0;  // samples
  double deviation_ = 0.5;
  double level_ = 1.0;  // mean power, over that of the samples
  double deviation_error_ = INFINITY;
  double gain_ = 0.0;
  Eigen::Index stretch_ = 1;  // samples
  // Mean square of all replicates; 0: of each its own, where that is likelier.
  double common_ = 0.0;
  // Runs of stretches that a fit looks at: sums of squares over that.
  std::vector<Eigen::ArrayXd> runs_;
  double share_ = 1.0;  // of all samples
};

}  // namespace imunoise
