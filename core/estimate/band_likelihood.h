#pragma once

#include <Eigen/Core>
#include <vector>

namespace imunoise {

/// How the cross spectra of k channels move with a parameter: one spectrum times one matrix.
struct SpectralDirection {
  Eigen::ArrayXd spectrum;  ///< at the bands, unit² per cycle/sample
  Eigen::MatrixXd matrix;   ///< k × k
};

/// Whittle's likelihood of one replicate under a model: in each band the coefficients of the k
/// channels' cosine transforms are jointly normal with the model's cross spectra Σ as covariance,
/// and independent of those in other bands. A signal is one channel. Symmetric k × k matrices over
/// the bands are arrays of bands × k² numbers, entry (a, b) in column a + b·k.
class BandLikelihood {
 public:
  /// `count`: coefficients in each band; `expected`: Σ, bands × k².
  BandLikelihood(const Eigen::ArrayXd& count, const Eigen::ArrayXXd& expected);

  /// -log likelihood in nats, less what does not depend on the model: Σ n/2 (log det Σ + tr Σ⁻¹C),
  /// C the mean products that were measured, bands × k². Infinite where Σ is singular.
  double objective(const Eigen::ArrayXXd& measured) const;

  /// √(n/2)·L⁻¹DL⁻ᵀ for each direction D, with Σ = LLᵀ: bands·k² × directions. Fisher's information
  /// is slopesᵀ·slopes, the score slopesᵀ·excess. Zero where Σ is singular.
  Eigen::MatrixXd slopes(const std::vector<SpectralDirection>& directions) const;
  /// √(n/2)·(L⁻¹CL⁻ᵀ - 1), the same rows.
  Eigen::VectorXd excess(const Eigen::ArrayXXd& measured) const;

 private:
  Eigen::ArrayXXd whitened(Eigen::ArrayXXd symmetric) const;
  auto factor(Eigen::Index row, Eigen::Index column) const {
    return factor_.col(row + column * channels_);
  }

  Eigen::Index channels_;
  Eigen::ArrayXd half_count_;
  Eigen::ArrayXXd factor_;  // L below the diagonal, its inverse on it
  bool singular_ = false;
};

}  // namespace imunoise
