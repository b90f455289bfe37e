#pragma once

#include <vector>

#include "core/regression/current.h"

namespace imunoise {

/// The power of what a model leaves, in a narrow stretch of frequencies, against the model's.
/// One-sided spectral densities, unit²/Hz.
struct SpectrumPoint {
  double frequency = 0.0;  ///< Hz, geometric middle
  double measured = 0.0;   ///< mean of all replicates
  double lower = 0.0;      ///< 95 % interval of the measured under χ²
  double upper = 0.0;
  double model = 0.0;
  double peak = 0.0;  ///< of the strongest single frequency, mean of all replicates
};

/// The spectrum of what the effects of a model leave, from the longest period of the longest
/// replicate to half the rate; some thirty points a decade.
std::vector<SpectrumPoint> spectral_view(const Current& current);

}  // namespace imunoise
