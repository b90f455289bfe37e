#include "core/diagnosis/proof.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace imunoise {

RankedTerm ranked(TriedTerm tried, double searches) {
  const double chance = std::min(1.0, searches * std::exp(tried.log_p));
  return {std::move(tried), chance, {}, {}};
}

Levels levels_of(double level) {
  constexpr double kSpent = 0.8;        // chances are approximations
  constexpr double kMisfitShare = 0.2;  // of that
  const double spent = kSpent * level;
  return {.term = spent * (1.0 - kMisfitShare), .misfit = spent * kMisfitShare};
}

bool proven(const RankedTerm& effect, const std::optional<HeldOut>& before) {
  if (!effect.heldout || !before) return true;
  return effect.heldout->total_likelihood() > before->total_likelihood();
}

}  // namespace imunoise
