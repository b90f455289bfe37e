#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/support/frequency.h"

namespace imunoise {

/// Bands of the coefficients k = 1 … n-1 of a cosine transform of length n. The first 256 stand
/// alone; above, a band is about 1/256 of its frequency wide, over which the spectra of all but the
/// sharpest resonances are straight.
struct Bands {
  /// Precondition: n ≥ 2.
  explicit Bands(Eigen::Index n);

  Eigen::Index size() const { return frequency.size(); }

  Frequencies frequency;            ///< middle of each, cycles per sample
  Eigen::ArrayXd count;             ///< coefficients in each
  std::vector<Eigen::Index> edges;  ///< place of the first coefficient of each, and the end
};

/// Standard deviation of the frequencies of so many neighbouring coefficients of a cosine transform
/// of length n, cycles per sample.
Eigen::ArrayXd scatter_in_bands(const Eigen::ArrayXd& count, Eigen::Index n);

/// How many coefficients of a cosine transform of length n lie below a frequency, in cycles per
/// sample: where the same frequency begins in transforms of different lengths.
Eigen::Index coefficients_below(double frequency, Eigen::Index n);

}  // namespace imunoise
