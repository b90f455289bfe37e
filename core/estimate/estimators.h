#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/estimate/problem.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise {

enum class Weighting {
  kDiagonal,  ///< Ω = diag(1/(upper - lower)²) of the χ² intervals: the peers' objective
  kFull,      ///< Ω = V(θ̂)⁻¹, the exact covariance of the moments under the model, iterated
};

/// One matrix a replicate; replicates of equal length and scales share theirs.
class PerReplicate {
 public:
  const Eigen::MatrixXd& operator[](std::size_t replicate) const {
    return distinct_[index_[replicate]];
  }
  /// make(wv) is called once for each distinct (length, scales, efficiency).
  template <class Make>
  static PerReplicate of(std::span<const WaveletVariance> replicates, const Make& make);

 private:
  std::vector<Eigen::MatrixXd> distinct_;
  std::vector<std::size_t> index_;
};

/// Covariance V(θ) of the moments of each replicate under the model; widened by 1/efficiency for
/// the robust estimator.
PerReplicate moment_covariances(const Model& model, std::span<const WaveletVariance> replicates);

/// An estimate and the weights that it was made with.
struct Estimate {
  Model model;             ///< all values set, sorted
  double objective = 0.0;  ///< Σ_k (ν̂_k - ν(θ̂))ᵀ Ω_k (ν̂_k - ν(θ̂))
  Termination termination = Termination::kLinear;
  Weighting weighting = Weighting::kFull;
  std::vector<Eigen::MatrixXd> weight_roots;  ///< one a replicate, Ω = rootᵀ·root
};

/// MuGMWM (Radi et al. 2019): one model for K replicates, which may differ in length. K = 1 is the
/// GMWM of Guerrier et al. 2013. Precondition: at least one replicate, all of one rate, each with
/// scales.
Estimate mugmwm(const Model& model, std::span<const WaveletVariance> replicates,
                Weighting weighting, const Progress& progress = {});

/// AGMWM: the average of the parameters (per sample, as in the grammar) of K separate GMWM fits,
/// which are returned too. `objective` is the sum of theirs; weight_roots are theirs.
struct AverageEstimate {
  Estimate average;
  std::vector<Estimate> separate;
};
AverageEstimate agmwm(const Model& model, std::span<const WaveletVariance> replicates,
                      Weighting weighting, const Progress& progress = {});

template <class Make>
PerReplicate PerReplicate::of(std::span<const WaveletVariance> replicates, const Make& make) {
  PerReplicate out;
  std::vector<const WaveletVariance*> first;
  for (const WaveletVariance& wv : replicates) {
    std::size_t i = 0;
    while (i < first.size() && !(first[i]->samples == wv.samples && first[i]->scales == wv.scales &&
                                 first[i]->efficiency == wv.efficiency)) {
      ++i;
    }
    if (i == first.size()) first.push_back(&wv);
    out.index_.push_back(i);
  }
  for (const WaveletVariance* wv : first) out.distinct_.push_back(make(*wv));
  return out;
}

}  // namespace imunoise
