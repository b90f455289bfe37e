#pragma once

#include <vector>

#include "core/diagnosis/heldout.h"

namespace imunoise {

/// How far the integral of a channel runs off in `seconds` after its bias was averaged for as long:
/// root mean square, unit · s. It is 2τ√ν at the half-width τ.
struct RunOff {
  double seconds = 0.0;
  double predicted = 0.0;  ///< by the model's noise
  double measured = 0.0;   ///< over all replicates, with the model's effects taken out
};

/// After 1, 10, 100 and 1000 s, as far as the replicates are long enough.
/// `left`: left_over() of the model.
std::vector<RunOff> run_off_of(const Trial& trial, const LeftOver& left);

}  // namespace imunoise
