#pragma once

#include <string>
#include <vector>

#include "core/regression/current.h"

namespace imunoise {

/// What a witness would explain behind each lag.
struct LagCurve {
  std::string witness;
  std::vector<double> seconds;  ///< rising; negative: the witness comes after its effect
  std::vector<double> nats;     ///< log-likelihood gained there, to first order
  double chance = 0.0;          ///< nats that the best lag gains by chance once in twenty
  double path = 0.0;            ///< length of the search, rad: Search::path
};

/// A curve for each witness of a subject long enough for lags.
std::vector<LagCurve> lag_curves(const Current& current);

}  // namespace imunoise
