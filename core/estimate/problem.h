#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include "core/model/model.h"
#include "core/support/progress.h"

namespace imunoise {

/// A term of the model that acts on some moments, with one entry of its power matrix.
struct Share {
  std::size_t term = 0;
  Eigen::Index entry = 0;  ///< in the packed upper triangle; 0 for a power that is a number
  friend bool operator==(const Share&, const Share&) = default;
};

/// The wavelet variances of one signal, or the cross-covariances of two: the model expects
/// Σ power(share) · shape_term(m), both where the covariate is what it was.
struct Segment {
  Scales scales;
  std::vector<Share> shares;
  double covariate = 0.0;  ///< in [-1, 1]: what the terms' trends follow
};

/// Measured moments that are weighted together.
struct MomentBlock {
  std::vector<Segment> segments;
  Eigen::VectorXd measured;     ///< n moments, segment after segment, in unit²
  Eigen::MatrixXd weight_root;  ///< r × n: Ω = rootᵀ·root
};

/// The one estimation problem: θ̂ = argmin Σ_b (ν̂_b - ν_b(θ))ᵀ Ω_b (ν̂_b - ν_b(θ)). Every estimator
/// of the house builds one: which terms a segment names is the tying map (a term named by several
/// segments is shared by them).
struct Problem {
  Model model;  ///< parameters that are given stay as they are
  std::vector<MomentBlock> blocks;
  /// Terms whose power is a symmetric positive semidefinite matrix rather than a number: its size.
  /// Such a term's own power is not given; it is 1 in every result. It has no trends.
  std::map<std::size_t, Eigen::Index> matrix_powers{};
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
  Model model;  ///< with all values and slopes set
  std::map<std::size_t, Eigen::MatrixXd> matrix_powers{};
  double objective = 0.0;
  Termination termination = Termination::kLinear;
};

/// Solves a problem without matrix powers, of at most 64 terms. Powers are found exactly by
/// non-negative least squares for each trial of the
/// other parameters, which are scanned on a grid and then refined from the best points of it, and
/// from the best smaller model plus one more term. No random numbers: the same answer on every run
/// and for any number of threads.
Minimum minimise(const Problem& problem, const Progress& progress = {});

/// Refines given points only, the shapes and slopes of models of the same terms, and returns the
/// best.
/// Precondition: at least one.
Minimum minimise_from(const Problem& problem, std::span<const Model> starts,
                      const Progress& progress = {});

inline Minimum minimise_from(const Problem& problem, const Model& start,
                             const Progress& progress = {}) {
  return minimise_from(problem, std::span(&start, 1), progress);
}

/// Refines the best point of the scan only: good enough to make weights from, at a fraction of the
/// cost.
Minimum minimise_roughly(const Problem& problem, const Progress& progress = {});

}  // namespace imunoise
