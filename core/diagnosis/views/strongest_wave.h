#pragma once

#include <optional>

#include "core/regression/current.h"

namespace imunoise {

/// The strongest single frequency of what a model leaves.
struct StrongestWave {
  double frequency = 0.0;  ///< Hz
  /// Periodogram there over the model's noise, mean of all replicates; 1 is expected at a frequency
  /// chosen beforehand.
  double power = 0.0;
  double chance_median = 0.0;  ///< of the strongest under a true model
  double chance_limit = 0.0;   ///< that it passes once in twenty
  double p_value = 1.0;
};

/// Over all frequencies with at least 8 periods in the shortest replicate; none if there are none.
/// Chances: upcrossings of a χ² process along frequency (Davies 1987).
std::optional<StrongestWave> strongest_wave(const Current& current);

}  // namespace imunoise
