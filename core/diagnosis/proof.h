#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/diagnosis/heldout.h"
#include "core/search/suggestion.h"

namespace imunoise {

/// A tried term with what it does on data that it was not fitted to.
struct RankedTerm {
  TriedTerm tried;
  double familywise_p = 1.0;
  std::optional<HeldOut> heldout;          ///< absent where nothing can be held out
  std::vector<std::string> confused_with;  ///< ids of effects that these data cannot exclude
};

RankedTerm ranked(TriedTerm tried, double searches);
/// Fills in `heldout`. Beside noise of changing power, a strong term gets a new fit first.
void hold_out(RankedTerm& one);

/// How the chance of a false alarm over everything that is tried is spent.
struct Levels {
  double term = 0.0;    ///< on terms of known causes, all together,
  double misfit = 0.0;  ///< and on misfits of unknown cause
};
Levels levels_of(double level);

/// Whether data that were not used became more likely; true where nothing can be held out.
bool proven(const RankedTerm& effect, const std::optional<HeldOut>& before);

}  // namespace imunoise
