#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/array/latents.h"

namespace imunoise {

/// Waits for readings that repeat themselves longer than a sensor's noise lets them. Of a sensor
/// with resolution q, the model says that N + 1 readings in a row are equal with probability at
/// most
///   Π_j erf(q / √(8 S_j)),  j = 1 .. N,
/// S_j the variance of a difference of readings given the j - 1 before it, less that of rounding:
/// no interval as long as q holds the next reading more often than one in the middle of its
/// distribution.
class StuckWatch {
 public:
  /// Fewer repetitions may be a transport that delivered a sample again.
  static constexpr std::size_t kFewest = 4;

  /// `resolution` is the least difference between two readings, one a sensor, in the model's unit;
  /// 0 where readings are continuous. `false_alarms` is how many times a sample it may cry wolf.
  StuckWatch(const ArrayModel& model, std::vector<Eigen::Index> used,
             const std::vector<double>& resolution, double false_alarms);

  /// How often a reading must repeat; 0 where a sensor's noise is too small for its resolution to
  /// tell.
  const std::vector<std::size_t>& repetitions() const { return most_; }
  /// Takes the next readings of all sensors; true when one of those used has repeated itself too
  /// long.
  bool feed(const Eigen::Ref<const Eigen::VectorXd>& readings);
  /// Whether one of those used repeats itself half as long as it must: it may be stuck.
  bool in_doubt() const;
  /// How often the last reading of `used[index]` has been repeated, and the log-likelihood that a
  /// stuck sensor gains by it; 0 while it is not too often.
  std::size_t repeated(Eigen::Index index) const;
  double gain(Eigen::Index index) const;

 private:
  std::vector<Eigen::Index> used_;
  std::vector<std::size_t> most_;
  std::vector<double> gain_;  // a repetition
  std::vector<std::size_t> repeated_;
  Eigen::VectorXd before_;
};

}  // namespace imunoise
