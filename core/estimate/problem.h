#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "core/model/model.h"
#include "core/support/progress.h"

namespace imunoise {

/// Measured moments of one signal, which the model must meet.
struct MomentBlock {
  Scales scales;
  Eigen::VectorXd measured;        ///< n wavelet variances ν̂, in unit²
  Eigen::MatrixXd weight_root;     ///< r × n: Ω = rootᵀ·root
  std::vector<std::size_t> terms;  ///< indices of the model's terms that act on this signal
};

/// The one estimation problem: θ̂ = argmin Σ_b (ν̂_b - ν_b(θ))ᵀ Ω_b (ν̂_b - ν_b(θ)). Every estimator
/// of the house builds one: which terms a block names is the tying map (a term named by several
/// blocks is shared by them).
struct Problem {
  Model model;  ///< parameters that are given stay as they are
  std::vector<MomentBlock> blocks;
};

/// How the search ended.
enum class Termination {
  kConverged,    ///< the objective no longer falls
  kEvaluations,  ///< the limit of evaluations came first: the result is the best seen
  kLinear,       ///< nothing nonlinear to search
  kStopped,      ///< the caller stopped it
};
std::string_view describe(Termination termination);

struct Minimum {
  Model model;  ///< with all values set, sorted
  double objective = 0.0;
  Termination termination = Termination::kLinear;
};

/// Solves the problem. Powers are found exactly by non-negative least squares for each trial of the
/// other parameters, which are scanned on a grid and then refined from the best points of it, and
/// from the best smaller model plus one more term. No random numbers: the same answer on every run
/// and for any number of threads.
Minimum minimise(const Problem& problem, const Progress& progress = {});

/// Refines one point only: the shapes of `start`, a model of the same terms.
Minimum minimise_from(const Problem& problem, const Model& start, const Progress& progress = {});

/// Refines the best point of the scan only: good enough to make weights from, at a fraction of the
/// cost.
Minimum minimise_roughly(const Problem& problem, const Progress& progress = {});

}  // namespace imunoise
