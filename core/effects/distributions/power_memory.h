#pragma once

#include <vector>

#include "core/regression/modulation.h"

namespace imunoise {

/// How well the power of innovations remembers what it was some time before.
struct PowerMemory {
  double tau = 0.0;  ///< correlation time, samples
  /// What following the power of that time would gain where it wanders little; where it wanders so
  /// much that one sees its course, less.
  double nats = 0.0;
  double variance = 0.0;  ///< of the power over its mean, where it wanders little
};

/// The score test (Rao 1948, Proc. Camb. Phil. Soc. 44:50) of a power whose logarithm is a Markov
/// process of small variance, against one power in each replicate: products of squares, each pair
/// weighted by its time apart. All correlation times from 2 samples on, by octaves.
std::vector<PowerMemory> power_memory(const Innovations& innovations);

}  // namespace imunoise
