#include "core/diagnosis/proof.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace imunoise {

RankedTerm ranked(TriedTerm tried, double searches) {
  const double chance = std::min(1.0, searches * std::exp(tried.log_p));
  return {std::move(tried), chance, {}, {}};
}

void hold_out(RankedTerm& one) {
  // Nats. The coefficient of a weaker term loses less than half a standard error.
  constexpr double kStrong = 30.0;
  TriedTerm& tried = one.tried;
  const auto& evenings = tried.fitted.regression.subject().evenings;
  const bool weighted = std::any_of(evenings.begin(), evenings.end(),
                                    [](const auto& evening) { return evening->weights_samples(); });
  if (weighted && tried.term() != nullptr && tried.likelihood_gain > kStrong)
    tried.fitted = found_anew(std::move(tried.fitted));
  one.heldout = held_out(tried.fitted);
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
