#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "core/model/model.h"
#include "core/regression/modulation.h"

namespace imunoise {

/// How the power of the noise moves: the logarithm of the innovations' power over short stretches,
/// as a series of its own. Under normal noise of constant power it is white, of known variance.
/// Power that wanders by itself is a Markov process beside it: any slow course explains some of
/// that, as a walk is explained by another (Granger & Newbold 1974, J. Econometrics 2:111).
class PowerView {
 public:
  /// None where a replicate is too short.
  static std::optional<PowerView> of(const Innovations& innovations);

  /// What a course of the variance explains.
  struct Explained {
    double gain = 0.0;   ///< nats that it gains beside power that wanders by itself,
    double alone = 0.0;  ///< and were the power constant otherwise
    bool steady = true;  ///< beside the course, the power is constant but for chance
  };
  Explained explained(const VarianceCourse& course) const;

  /// Nats that wandering power gains over constant power, which tails or outliers may disturb.
  double wander_gain() const;

  /// How much more the mean power of replicates varies than that of constant power does, and the
  /// degrees of freedom that this is known with.
  struct Spread {
    double inflation = 1.0;
    double dof = INFINITY;  ///< infinite where the power is constant
  };
  Spread of_means() const;

  /// Power that wanders as slowly as a replicate is long, and makes replicates differ as they do,
  /// would show within them, and does not. For several replicates.
  bool rules_out_wander() const;

 private:
  struct Replicate {
    std::size_t number;       // in the subject
    double level;             // mean of the logarithms,
    Eigen::VectorXd power;    // which are less it; of quick_length()
    Eigen::VectorXd cosines;  // their transform
  };
  // A fit to all replicates, with or without a course.
  struct Fit {
    Model noise;
    double log_likelihood = 0.0;
  };

  Fit fitted(const Model& start, const std::vector<Eigen::VectorXd>* course) const;
  // The best of some starts.
  Fit wandering(const std::vector<Eigen::VectorXd>* course) const;
  double mean_length() const;  // of a replicate, stretches
  std::vector<Eigen::VectorXd> stretched(const VarianceCourse& course) const;

  std::vector<Replicate> replicates_;
  Fit chance_;    // white, of the variance that normal noise has
  Fit constant_;  // white
  Fit wander_;    // a Markov process beside it
};

}  // namespace imunoise
