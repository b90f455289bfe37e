#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/estimate/per_replicate.h"
#include "core/estimate/problem.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise {

enum class Weighting {
  kDiagonal,  ///< Ω = diag(1/(upper - lower)²) of the χ² intervals: the peers' objective
  kFull,      ///< Ω = V(θ̂)⁻¹, the exact covariance of the moments under the model, iterated
};

/// One n × n matrix a replicate, for its n moments.
using MomentCovariances = PerReplicate<Eigen::MatrixXd>;

/// Covariance V(θ) of the moments of each replicate under the model; widened by 1/efficiency for
/// the robust estimator.
MomentCovariances moment_covariances(const Model& model,
                                     std::span<const WaveletVariance> replicates);

/// The problem of one model for all replicates, with weights given: Ω_k = rootᵀ·root, one root a
/// replicate. Replicates with the same scales and weights enter as their average, which has the
/// same minimum and objective.
Problem tied_problem(const Model& model, std::span<const WaveletVariance> replicates,
                     std::span<const Eigen::MatrixXd> weight_roots);

/// Weights of the peers' objective, one root a replicate: diag(1/(upper - lower)) of its χ²
/// intervals.
std::vector<Eigen::MatrixXd> diagonal_roots(std::span<const WaveletVariance> replicates);

/// Weights of the exact covariance under a model, one root a replicate: Ω = V⁻¹.
std::vector<Eigen::MatrixXd> full_roots(const Model& model,
                                        std::span<const WaveletVariance> replicates);
/// False for a model that explains nothing at some scale: it gives no weights.
bool gives_weights(const Model& model, std::span<const WaveletVariance> replicates);

/// An estimate and the weights that it was made with.
struct Estimate {
  Model model;             ///< all values set, sorted
  double objective = 0.0;  ///< Σ_k (ν̂_k - ν(θ̂))ᵀ Ω_k (ν̂_k - ν(θ̂))
  Termination termination = Termination::kLinear;
  Weighting weighting = Weighting::kFull;
  std::vector<Eigen::MatrixXd> weight_roots;  ///< one a replicate, Ω = rootᵀ·root
};

/// MuGMWM (Radi et al. 2019): one model for K replicates, which may differ in length. K = 1 is the
/// GMWM of Guerrier et al. 2013. With full weights, white noise keeps its name: a Markov process
/// whose memory the data do not show takes no power from a WN term. Precondition: at least one
/// replicate, all of one rate, each with scales.
Estimate mugmwm(const Model& model, std::span<const WaveletVariance> replicates,
                Weighting weighting, const Progress& progress = {});

/// AGMWM: the average of the parameters (per sample, as in the grammar) of K separate GMWM fits,
/// which are returned too, their terms matched() to those of the pooled estimate. `objective` is
/// the sum of theirs; weight_roots are theirs.
struct AverageEstimate {
  Estimate average;
  std::vector<Estimate> separate;
  /// The largest factor, over scales, between the variance of the average and the mean variance of
  /// the separate fits; 1 where they agree. Where it is large, the average describes no replicate.
  double disagreement = 1.0;
};
AverageEstimate agmwm(const Model& model, std::span<const WaveletVariance> replicates,
                      Weighting weighting, const Progress& progress = {});

}  // namespace imunoise
