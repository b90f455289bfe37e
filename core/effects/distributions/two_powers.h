#pragma once

#include <optional>
#include <vector>

#include "core/regression/modulation.h"
#include "core/support/units.h"

namespace imunoise {

/// How long noise stays at its larger power, and how often it gets there.
struct BurstTimes {
  double length_s = 1.0;  ///< mean
  double every_s = 10.0;  ///< mean time from the begin of one to that of the next
};

/// Noise that switches between two powers at random: a hidden Markov chain over stretches of some
/// samples, with the likelihood of their power (Rabiner 1989, Proc. IEEE 77:257).
class TwoPowers {
 public:
  /// The fit of most likelihood, of these times or of any; without gain where a replicate is too
  /// short or silent. `rate`: of the innovations.
  static TwoPowers of(const Innovations& innovations, Hertz rate,
                      const std::optional<BurstTimes>& times = {});

  double gain() const;  ///< nats over one power in each replicate
  double gain_in(std::size_t replicate) const;
  BurstTimes times() const;
  double ratio() const { return variance_[1] / variance_[0]; }
  /// Kurtosis of what has these powers, over that of normal numbers.
  double kurtosis_ratio() const;
  /// The factor that turns each innovation of a replicate into a normal number of the smaller
  /// power: the number with the same tail probability, given all earlier innovations (Rosenblatt
  /// 1952, Ann. Math. Stat. 23:470). Later innovations must not count: they would make the power
  /// too even.
  Eigen::ArrayXd factor(std::size_t replicate, const Eigen::VectorXd& white) const;

 private:
  struct Replicate {
    Eigen::ArrayXd power;  // mean squares of the stretches, in a unit
    double unit = 1.0;
    double level = 1.0;   // mean of its powers
    Eigen::ArrayXd loud;  // chance that the stretch has the larger power
    double likelihood = 0.0;
    double gain = 0.0;
    double starts = 0.0;  // expected number of bursts that begin,
    double ends = 0.0;    // and end
  };

  void expect(Replicate& one) const;
  void maximise(bool times);
  enum class Levels { kOwn, kCommon };
  bool cut(const Innovations& innovations, Eigen::Index stretch, Levels levels);
  TwoPowers of_one_level(const Innovations& innovations, bool times) const;
  void climb(bool times, int steps);
  void sharpen(const Innovations& innovations, bool times);
  double likelihood() const;
  double stretch_s() const;

  double rate_ = 1.0;
  Eigen::Index stretch_ = 1;  // samples
  std::vector<Replicate> replicates_;
  double variance_[2] = {1.0, 4.0};  // the smaller, the larger
  double change_[2] = {0.01, 0.1};   // chances to leave each, a stretch
};

}  // namespace imunoise
