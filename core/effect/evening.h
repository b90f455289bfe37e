#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/model/model.h"
#include "core/support/linear_algebra.h"
#include "core/support/shared_vector.h"

namespace imunoise {

/// How a term made noise of changing power even: it whitens the samples, multiplies each by a
/// factor, and colours them again. The same happens to what effects add, so that a fit weights each
/// sample by its power.
struct Evening {
  std::vector<Model> noise;  ///< what whitens: of each replicate, or one for all
  /// A replicate each: of each sample, a single one of all, or none where nothing changes.
  std::vector<SharedVector> factor;

  /// Whether the power changes clearly in any replicate, so that samples have weights of their own.
  bool weights_samples() const;
  const Model& noise_of(std::size_t replicate) const {
    return noise[noise.size() == 1 ? 0 : replicate];
  }
};

/// Spectrum of a noise model at the coefficients 1 … n-1 of a cosine transform of length n, taken
/// as straight within each band. Unit² per cycle/sample.
Eigen::ArrayXd spectrum_of_cosines(const Model& noise, Eigen::Index n);

/// A series of one replicate made even, from its cosine_transform() to that of the result.
Eigen::VectorXd made_even(const Evening& how, std::size_t replicate, const VectorRef& cosines);

}  // namespace imunoise
