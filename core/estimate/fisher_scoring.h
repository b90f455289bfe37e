#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/estimate/problem.h"
#include "core/support/progress.h"

namespace imunoise {

/// Which information is asked for: Fisher's, or also what was observed, which costs more.
enum class Asked { kFisher, kObserved };

/// What a likelihood looks like next to a point.
struct Curvature {
  Eigen::MatrixXd information;  ///< Fisher's, n × n
  Eigen::VectorXd score;        ///< slope of the log likelihood, n
  /// What the observed information has more, n × n; empty where it is not known or not asked for.
  Eigen::MatrixXd correction{};
};

/// A likelihood to be maximised over n coordinates.
struct Likelihood {
  /// What each coordinate, or run of them, may be, in their order: kFree, any number; 1, a power
  /// ≥ 0; s > 1, the packed upper triangle of a positive semidefinite s × s matrix.
  std::vector<Eigen::Index> cones;
  std::function<double(const Eigen::VectorXd&)> objective;  ///< -log likelihood; may be infinite
  std::function<Curvature(const Eigen::VectorXd&, Asked)> curvature;

  static constexpr Eigen::Index kFree = 0;
};

struct Scored {
  Eigen::VectorXd at;
  double objective = 0.0;
  Termination termination = Termination::kConverged;
};

/// Fisher scoring from `start`, and Newton's steps by the observed information, where it is known,
/// once a step gains less than a nat. A start whose objective is not finite is returned as it is.
/// Each step solves the least squares of the linearised likelihood inside the cones, with more and
/// more damping until the likelihood grows. A free coordinate moves by at most 1 a step, so it is
/// best on a logarithmic or logit scale.
Scored fisher_scoring(const Likelihood& likelihood, const Eigen::VectorXd& start,
                      const Progress& progress = {}, int most_steps = 100);

/// Fisher scoring from a start that may be lost: where a shape is at the end of its scale, say a
/// time far beyond the recording's, the likelihood is flat in it and scoring cannot leave. Free
/// coordinates whose information is below 1 (a unit of their scale is within a standard error) are
/// walked to the nearest place where it is not, and the better of both ends is returned.
Scored maximise(const Likelihood& likelihood, const Eigen::VectorXd& start,
                const Progress& progress = {});

}  // namespace imunoise
