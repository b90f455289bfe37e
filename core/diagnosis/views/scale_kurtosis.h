#pragma once

#include <vector>

#include "core/regression/modulation.h"

namespace imunoise {

/// How far the Haar coefficients of some innovations are from normal, at one averaging time.
struct ScaleKurtosis {
  double seconds = 0.0;  ///< averaging time
  double excess = 0.0;   ///< kurtosis less 3
  double error = 0.0;    ///< standard error of that, were the innovations normal: √(24/n)
};

/// Excess kurtosis at averaging times of 2, 4, 8, … samples (and of the innovations themselves, one
/// sample), as long as there are enough coefficients that do not overlap. Each replicate counts
/// against its own level. `rate` in Hz.
std::vector<ScaleKurtosis> scale_kurtosis(const Innovations& innovations, double rate);

}  // namespace imunoise
