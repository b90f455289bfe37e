#include "core/diagnosis/shared_noise.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/diagnosis/catalogue.h"

namespace imunoise {
namespace {

constexpr std::size_t kMostNoises = 3;     // that are looked at,
constexpr std::size_t kMostCouplings = 3;  // each beside so many
constexpr double kStillThere = 0.8;        // of a leak's gain, beside noise that is not shared

// The witness of a coupling that may be motion which both sensors feel, or null.
const Witness* shares_motion(const TriedEffect& tried) {
  const auto* term = std::get_if<EffectTerm>(&tried.suggestion.added);
  if (term == nullptr || term->kind != EffectKind::kWitness) return nullptr;
  const Subject& subject = tried.trial.regression.subject();
  const Witness* const out = subject.find(term->witness);
  return out != nullptr && may_share_motion(subject.quantity, *out) ? out : nullptr;
}

struct SharedMotion {
  const Witness* with = nullptr;  // null: none
  double gain = 0.0;
  double log_chance = 0.0;
};

SharedMotion shared_motion(const TriedEffect& noise, const std::vector<TriedEffect>& tried) {
  const Current with = current_of(noise.trial.regression, noise.trial.fit);
  SharedMotion out;
  std::size_t looked = 0;
  for (const TriedEffect& other : tried) {
    const Witness* const witness = shares_motion(other);
    if (witness == nullptr || looked++ == kMostCouplings) continue;
    const Trial both = try_out(with, other.suggestion);
    const double gain = both.fit.log_likelihood - with.fit.log_likelihood;
    if (gain > kStillThere * other.likelihood_gain) continue;
    const Suggestion& how = other.suggestion;
    const double chance = log_chance(gain, how.dof, other.freedom, how.power, how.search);
    if (chance < out.log_chance) out = {witness, gain, chance};
  }
  return out;
}

}  // namespace

bool told_by_spectrum(std::string_view effect) {
  return effect == "gauss_markov" || effect == "flicker" || effect == "resonance";
}

void name_shared_noise(std::vector<TriedEffect>& tried, double searches, double level) {
  const double surely_there = std::log(level / searches);
  const double surely_shared = std::log(level / (kMostNoises * kMostCouplings));
  std::vector<std::pair<TriedEffect*, SharedMotion>> found;
  std::size_t looked = 0;
  for (TriedEffect& one : tried) {
    if (!told_by_spectrum(one.effect) || !(one.log_chance < surely_there)) continue;
    if (looked++ == kMostNoises) break;
    const SharedMotion shared = shared_motion(one, tried);
    if (shared.with != nullptr && shared.log_chance < surely_shared)
      found.emplace_back(&one, shared);
  }
  for (const auto& [one, shared] : found) {
    one->effect = "common_vibration";
    one->shared_with = shared.with->name;
    one->likelihood_gain += shared.gain;
    one->log_chance += shared.log_chance;
    one->gain = -one->log_chance;
  }
  best_first(tried);
}

}  // namespace imunoise
