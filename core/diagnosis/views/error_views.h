#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnosis/views/left_over.h"
#include "core/diagnosis/views/misfit.h"

namespace imunoise {

/// How far a model is from the data in one view of them: one number, and what chance makes of it.
///
/// A view over many places (averaging times, half octaves, stretches, replicates) is the root mean
/// square of its deviations, each weighted by the information on it: with normal scores z of the
/// deviations, taken orthogonal to the model's parameters, √(Σz²/Σ1/s²), s the standard error of a
/// deviation. Σz² is χ² under a true model, so that floor and limit are exact.
struct ErrorView {
  std::string_view view;  ///< averaging_times, spectrum, single_waves, …
  std::string_view unit;  ///< "%", "dB" or "1"
  double value = 0.0;
  double floor = 0.0;         ///< under a true model: root mean square, or median of a maximum
  double chance_limit = 0.0;  ///< that a true model passes once in twenty
  double p_value = 1.0;       ///< that a true model deviates as much

  /// Where it is worst; what is not known there is NaN or empty.
  struct Place {
    double from = std::numeric_limits<double>::quiet_NaN();  ///< s, or Hz
    double to = std::numeric_limits<double>::quiet_NaN();
    double deviation = 0.0;  ///< relative
    std::size_t replicate = 0;
    std::string witness{};
  } worst{};
};

/// The views of a fitted model, in this order: averaging_times (Allan deviation, %), spectrum
/// (power in half octaves, %), single_waves (strongest over the noise, dB), noise_over_time (power
/// in 16 stretches of each replicate, %), distribution (excess kurtosis), witnesses (share of the
/// innovations' power that the best explains, %), replicates (power, %). A view that the data
/// cannot show (one replicate, no witness, too few averaging times) is left out. `left`: what the
/// effects leave of each replicate, in octaves.
std::vector<ErrorView> error_views(const FittedModel& fitted, const LeftOver& left,
                                   const MisfitReport& misfit);

}  // namespace imunoise
