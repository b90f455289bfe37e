#pragma once

// What an observer sees of telegraph noise who knows its law and that of the noise around it, and
// not when it jumps.

#include "core/support/random.h"
#include "tests/hidden_effects/generator/white_walk.h"

namespace imunoise::hidden {

/// Noise that jumps between the levels ± height/2. It begins at either with the same probability;
/// before each later sample it jumps with probability 1/dwell (dwell in samples).
struct TwoLevelLaw {
  double height = 1.0;
  double dwell = 1000.0;
};

/// log_likelihood() of a walk in white noise and telegraph noise, summed over all courses of the
/// latter: a particle filter whose particles are courses, each with its own Kalman filter (Doucet
/// et al. 2000). Its error is a tenth of a nat where jumps can be told, for 1,000 particles.
double log_likelihood(const Series& x, const WhiteWalk& noise, const TwoLevelLaw& law,
                      RandomStream& random, std::size_t particles = 1000);

}  // namespace imunoise::hidden
