#pragma once

#include <vector>

#include "core/diagnosis/candidates.h"

namespace imunoise {

/// How far the integral of a channel runs off in `seconds` after its bias was averaged for as long:
/// root mean square, unit · s. It is 2τ√ν at the half-width τ.
struct RunOff {
  double seconds = 0.0;
  double predicted = 0.0;  ///< by the model's noise
  double measured = 0.0;   ///< over all replicates, with the model's effects taken out
};

/// After 1, 10, 100 and 1000 s, as far as the replicates of a trial are long enough.
class RunOffs {
 public:
  explicit RunOffs(const Trial& trial);
  /// Takes in a replicate, with the effects taken out. Thread-safe, each replicate once.
  void add(std::size_t replicate, const Eigen::VectorXd& left);
  /// Once all replicates are in.
  std::vector<RunOff> found() const;

 private:
  const Trial* trial_;
  std::vector<double> seconds_;
  Scales half_widths_;
  std::vector<Eigen::ArrayXd> each_;  // a replicate: its wavelet variance at the half-widths
};

}  // namespace imunoise
