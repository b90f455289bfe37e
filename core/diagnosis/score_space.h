#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "core/process/process.h"
#include "core/regression/current.h"
#include "core/search/suggestion.h"

namespace imunoise {

/// Score tests of noise that may be missing, orthogonal to what the free parameters of the current
/// noise can do: whitened band powers of all lengths of replicates, one below the other.
class ScoreSpace {
 public:
  /// Borrows `current`.
  explicit ScoreSpace(const Current& current);

  /// The direction of a new spectrum, scaled to length 1, less what the parameters can do.
  Eigen::VectorXd direction(const Process& process) const;

  /// How far the data lie along it: a normal score.
  double score(const Eigen::VectorXd& direction) const;

  /// Square root of the information on the power of a process: 1/standard error.
  double precision(const Process& process) const;

 private:
  Eigen::VectorXd whitened(const Process& process) const;

  const std::vector<BandedPower>& pooled_;
  Eigen::ArrayXd root_;
  Eigen::VectorXd excess_;
  Eigen::MatrixXd slopes_;
  Eigen::MatrixXd inverse_;
};

/// Adds the best of a scanned family of processes, if there is any.
void add_best(const Current& current, const ScoreSpace& space, std::string_view cause,
              const std::vector<Process>& family, Suggestions& out);

}  // namespace imunoise
