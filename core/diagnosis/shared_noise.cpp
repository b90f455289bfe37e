#include "core/diagnosis/shared_noise.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/diagnosis/catalogue.h"

namespace imunoise {
namespace {

constexpr std::size_t kMostNoises = 3;     // that are looked at,
constexpr std::size_t kMostCouplings = 3;  // each beside so many
constexpr double kLeastShare = 0.02;  // of the noise's gain that its being shared adds at least
constexpr double kClearly = 3.0;      // nats,
constexpr double kMuch = 0.1;         // or of what is explained: how much more than a leak

// A coupling to a sensor of the subject's kind, at all frequencies or at some.
struct Coupling {
  const TriedEffect* tried = nullptr;
  const Witness* witness = nullptr;
  bool whole = false;
};

std::vector<Coupling> couplings(const std::vector<TriedEffect>& tried) {
  std::vector<Coupling> out;
  for (const TriedEffect& one : tried) {
    const auto* term = std::get_if<EffectTerm>(&one.suggestion.added);
    if (term == nullptr || term->kind != EffectKind::kWitness) continue;
    if (term->lag > 0.0 || term->quadratic || term->derivative) continue;
    const Subject& subject = one.trial.regression.subject();
    const Witness* const witness = subject.find(term->witness);
    if (witness == nullptr || !may_share_motion(subject.quantity, *witness)) continue;
    out.push_back({&one, witness,
                   *term == EffectTerm{.kind = EffectKind::kWitness, .witness = term->witness}});
  }
  return out;
}

// A leak explains as much at all frequencies as at the best of them.
bool is_leak(const Coupling& one, const std::vector<Coupling>& all) {
  const double explained = one.tried->likelihood_gain;
  const double less = explained - std::max(kClearly, kMuch * explained);
  return std::any_of(all.begin(), all.end(), [&](const Coupling& other) {
    return other.whole && other.witness == one.witness && other.tried->likelihood_gain > less;
  });
}

struct SharedMotion {
  const Witness* with = nullptr;  // null: none
  double gain = 0.0;
  double log_chance = 0.0;
};

SharedMotion shared_motion(const TriedEffect& noise, const std::vector<Coupling>& vibrations) {
  const Current with = current_of(noise.trial.regression, noise.trial.fit);
  SharedMotion out;
  for (const Coupling& one : vibrations) {
    const Suggestion& how = one.tried->suggestion;
    const double gain = try_out(with, how).fit.log_likelihood - with.fit.log_likelihood;
    const double chance = log_chance(gain, how.dof, one.tried->freedom, how.power, how.search);
    if (chance < out.log_chance) out = {one.witness, gain, chance};
  }
  return out;
}

}  // namespace

void name_shared_noise(std::vector<TriedEffect>& tried, double searches, double level,
                       const Progress& progress) {
  const double surely_there = std::log(level / searches);
  const double surely_shared = std::log(level / (kMostNoises * kMostCouplings));
  const std::vector<Coupling> all = couplings(tried);
  std::vector<Coupling> vibrations;
  for (const Coupling& one : all) {
    if (!is_leak(one, all) && vibrations.size() < kMostCouplings) vibrations.push_back(one);
  }
  std::vector<std::pair<TriedEffect*, SharedMotion>> found;
  std::size_t looked = 0;
  for (TriedEffect& one : tried) {
    if (!told_by_spectrum(one.effect) || !(one.log_chance < surely_there)) continue;
    if (looked++ == kMostNoises || progress.stopped()) break;
    const SharedMotion shared = shared_motion(one, vibrations);
    if (shared.log_chance < surely_shared && shared.gain > kLeastShare * one.likelihood_gain)
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
