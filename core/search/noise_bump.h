#pragma once

// Noise that stands out in a band of frequencies, seen in what a fit leaves.

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "core/regression/current.h"
#include "core/support/linear_algebra.h"

namespace imunoise {

/// Between two frequencies, cycles per sample.
struct NoiseBump {
  double from = 0.0;
  double to = 0.0;
};

/// Where the power of all replicates stands out most over that beside it, by a fifth at least;
/// whether or not the model has noise for it.
std::optional<NoiseBump> highest_bump(const Current& current);

/// Spectrum of a replicate without what stands out between two frequencies: as measured, in wide
/// bands, and straight between the two. At its coefficients, as Current::spectrum.
Eigen::ArrayXd spectrum_beside(const Current& current, const NoiseBump& bump,
                               std::size_t replicate);

/// Mean square of the cosine_transform() of a series within a bump, in as wide bands, straight
/// between their middles; 1 elsewhere. At each of the coefficients.
Eigen::ArrayXd level_within(const VectorRef& cosines, const NoiseBump& bump);
/// How many wide bands a bump has.
double wide_bands(const NoiseBump& bump);

/// Kurtosis less 3 of what stands out. Noise is a sum of many waves, which is normal: 0. A tone
/// keeps to its amplitude.
struct BumpTails {
  double excess = 0.0;
  double error = INFINITY;  ///< standard error, if it is noise
  double of_tone = 0.0;     ///< what it would be if all that stands out were a tone
};
BumpTails tails_of(const Current& current, const NoiseBump& bump);

/// How much alike what is left and another channel are within a bump, at no lag and at a quarter of
/// a wave: χ² with two degrees of freedom a replicate if they are independent.
double alike_within(const Current& current, const NoiseBump& bump, const Witness& witness);

/// Whether a tone of unsteady frequency may be what looks like a resonance.
bool may_be_tone(const Current& current);

}  // namespace imunoise
