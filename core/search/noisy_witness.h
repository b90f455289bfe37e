#pragma once

#include <vector>

#include "core/regression/current.h"

namespace imunoise {

/// A witness less white noise of its own, where that explains most of what a model leaves: an
/// effect follows the signal, and noise of the witness makes the coefficient of what was recorded
/// too small.
struct NoisyWitness {
  double variance = 0.0;     ///< of that noise, per sample; 0 where none helps
  double gain = 0.0;         ///< nats that one coefficient of the rest explains
  double information = 0.0;  ///< 1/variance of that coefficient
  double log_error = 0.0;    ///< standard error of the logarithm of `variance`
  double to = 0.0;           ///< 95 % of the information lie below it, cycles per sample
};

/// `cosines`: the witness, one cosine_transform() a replicate.
NoisyWitness noisy_witness(const Current& current, const std::vector<SharedVector>& cosines);

}  // namespace imunoise
