#include "core/diagnosis/proof.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace imunoise {

namespace {

// Clearly: so that effects are weighed by it.
bool power_changes(const Subject& subject) {
  const auto weighs = [](const std::shared_ptr<const Evening>& one) {
    return std::any_of(one->factor.begin(), one->factor.end(),
                       [](const SharedVector& factor) { return factor.size() > 1; });
  };
  return std::any_of(subject.evenings.begin(), subject.evenings.end(), weighs);
}

}  // namespace

RankedTerm ranked(TriedTerm tried, double searches) {
  const double chance = std::min(1.0, searches * std::exp(tried.log_p));
  return {std::move(tried), chance, {}, {}};
}

void hold_out(RankedTerm& one) {
  constexpr double kStrong = 30.0;  // nats: 8 standard errors, of which a tenth may be missing
  TriedTerm& tried = one.tried;
  if (tried.term() != nullptr && tried.likelihood_gain > kStrong &&
      power_changes(tried.fitted.regression.subject()))
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
