#pragma once

// Numbers drawn from other laws than the normal one.

#include <cmath>
#include <cstddef>

#include "core/support/random.h"

namespace imunoise::hidden {

/// Evenly from [low, high).
inline double uniform(RandomStream& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random.engine()() >> 11U) * 0x1p-53);
}

/// Evenly in the logarithm, from [low, high); both positive.
inline double log_uniform(RandomStream& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

/// One of 0 … count-1.
inline std::size_t below(RandomStream& random, std::size_t count) {
  return static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(count)));
}

/// -1 or 1.
inline double sign(RandomStream& random) { return uniform(random, 0.0, 1.0) < 0.5 ? -1.0 : 1.0; }

}  // namespace imunoise::hidden
