#pragma once

#include <optional>
#include <string>

#include "core/regression/current.h"

namespace imunoise {

/// What the best witness explains of what a model leaves.
struct WitnessShare {
  std::string witness;
  double share = 0.0;          ///< of the innovations' power, 0 to 1
  double chance_median = 0.0;  ///< of that of the best under a true model
  double chance_limit = 0.0;   ///< that it passes once in twenty
  double p_value = 1.0;
};

/// The best of every witness in every half octave of frequency, in step, and behind every lag: a
/// log-likelihood of g nats is a share of 2g/samples. None without witnesses. The chances add up
/// those of all that is tried, which is a bound where witnesses are alike.
std::optional<WitnessShare> witness_share(const Current& current);

}  // namespace imunoise
