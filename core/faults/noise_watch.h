#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace imunoise {

/// How much more one sensor's innovations scatter than they should, over one window.
struct NoiseEvidence {
  double gain = 0.0;        ///< of the log-likelihood; 0 where they do not scatter more
  double ratio = 1.0;       ///< variance over what the model says
  std::size_t samples = 0;  ///< of the window
};

/// Tests of the variance of white innovations along one direction a sensor, over windows of 1, 2, 4
/// .. 2¹⁴ samples that lie end to end: exactly χ² where nothing is wrong and the variance is known,
/// F where it was fitted. Each length of window has
/// an equal share of the false alarms, and within it each sensor.
class NoiseWatch {
 public:
  static constexpr std::size_t kWindows = 15;

  /// `directions` holds one unit row a sensor; `degrees` of freedom is how well the variance of the
  /// innovations is known; `false_alarms` is how many times a sample it may cry wolf.
  NoiseWatch(Eigen::MatrixXd directions, double degrees, double false_alarms);
  /// One that gives evidence and no alarms.
  explicit NoiseWatch(Eigen::MatrixXd directions);

  /// Takes the next innovation; true when a window that ended with it is beyond its threshold.
  bool feed(const Eigen::Ref<const Eigen::VectorXd>& innovation);
  /// The strongest evidence against a sensor among the windows that ended with the last innovation.
  NoiseEvidence strongest(Eigen::Index sensor) const;

 private:
  Eigen::MatrixXd directions_;
  std::vector<double> thresholds_;  // of the sum of squares, one a length
  Eigen::MatrixXd waiting_;         // sensors × lengths: the first half of the next longer window
  Eigen::MatrixXd ended_;           // sensors × lengths: sums of the windows that ended now
  std::size_t lengths_ = 0;         // that ended now
  std::size_t seen_ = 0;            // innovations
};

}  // namespace imunoise
