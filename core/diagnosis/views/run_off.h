#pragma once

#include <cstdint>
#include <vector>

#include "core/regression/fitted_model.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise {

/// How far the integral of a channel runs off in `seconds` after its bias was averaged for as long:
/// root mean square, unit · s. It is 2τ√ν at the half-width τ.
struct RunOff {
  double seconds = 0.0;
  double predicted = 0.0;  ///< by the model's noise
  double measured = 0.0;   ///< over all replicates, with the model's effects taken out
  /// Of 2·seconds without overlap: how many values `measured` rests on.
  std::int64_t stretches = 0;
};

/// The half-widths that run_off_of() takes: 1, 10, 100 and 1000 s, as far as the replicates are
/// long enough.
Scales run_off_scales(const Subject& subject);

/// `left`: what the effects of a fitted model leave of each replicate, at those scales and any
/// others.
std::vector<RunOff> run_off_of(const FittedModel& fitted, const std::vector<WaveletVariance>& left);

}  // namespace imunoise
