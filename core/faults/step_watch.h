#pragma once

#include <cstdint>

#include "core/faults/model_doubt.h"

namespace imunoise {

/// A step of one sensor, as it looks after one block.
struct StepEvidence {
  double z = 0.0;           ///< standard normal where there is no step
  double size = 0.0;        ///< estimated, in the sensors' unit
  double error = 0.0;       ///< its standard error
  Eigen::Index blocks = 0;  ///< since the step
};

/// Generalised likelihood ratio test of a step in each sensor's parity (Willsky & Jones 1976), on
/// white innovations of blocks of one length: of steps 1 to 7 blocks ago for the shortest blocks, 4
/// to 7 for those that double another watch's.
class StepWatch {
 public:
  static constexpr Eigen::Index kMostBlocks = 7;

  /// `used` are the sensors to watch; `false_alarms` how many times a block it may cry wolf.
  StepWatch(const ArrayModel& model, const ModelDoubt& doubt, const std::vector<Eigen::Index>& used,
            std::int64_t block, Eigen::Index fewest_blocks, double false_alarms);

  std::int64_t block() const { return block_; }
  double threshold() const { return threshold_; }
  /// Takes the parity of the next block; true when some |z| is beyond the threshold.
  bool feed(const Eigen::Ref<const Eigen::VectorXd>& parity);
  /// The white innovation of the last block (r × 1); nothing while the history is too short.
  const Eigen::VectorXd* innovation() const { return seen_ > 0 ? &stream_.innovation() : nullptr; }
  const InnovationFilter& filter() const { return stream_.filter(); }
  /// The strongest evidence against sensor `used[index]`, after this block.
  StepEvidence strongest(Eigen::Index index) const;

 private:
  std::int64_t block_;
  Eigen::Index fewest_blocks_;
  InnovationStream stream_;
  Eigen::MatrixXd matched_;  // a unit row for each sensor and age: z = matched · recent
  Eigen::VectorXd norms_;    // of the responses to a unit step, in the same order
  Eigen::VectorXd recent_;   // innovations, newest first
  Eigen::VectorXd z_;
  Eigen::Index seen_ = 0;
  double threshold_;
};

}  // namespace imunoise
