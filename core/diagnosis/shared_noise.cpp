#include "core/diagnosis/shared_noise.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/diagnosis/causes.h"
#include "core/diagnosis/missing_noise.h"
#include "core/diagnosis/searches.h"
#include "core/diagnosis/views/misfit.h"
#include "core/effects/couplings/couplings.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

constexpr std::size_t kMostNoises = 3;     // that are looked at,
constexpr std::size_t kMostCouplings = 3;  // each beside so many
constexpr double kLeastShare = 0.02;  // of the noise's gain that its being shared adds at least
constexpr double kClearly = 3.0;      // nats,
constexpr double kMuch = 0.1;         // or of what is explained: how much more than a leak

// A coupling to a sensor of the subject's kind, at all frequencies or at some; or to an
// accelerometer that sees a gyroscope's bench turn.
struct Coupling {
  const TriedTerm* tried = nullptr;
  const Witness* witness = nullptr;
  bool whole = false;
};

std::vector<Coupling> couplings(const std::vector<TriedTerm>& tried) {
  std::vector<Coupling> out;
  for (const TriedTerm& one : tried) {
    const MotionCoupling how = one.suggestion.coupling;
    if (how == MotionCoupling::kNone) continue;
    const Subject& subject = one.fitted.regression.subject();
    const Witness* const witness = subject.find(one.term()->witness);
    if (witness == nullptr) continue;
    if (how == MotionCoupling::kTurning || may_share_motion(subject.quantity, *witness))
      out.push_back({&one, witness, how == MotionCoupling::kWhole});
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

// The best of those that are no leaks.
std::vector<Coupling> motions(const std::vector<TriedTerm>& tried) {
  const std::vector<Coupling> all = couplings(tried);
  std::vector<Coupling> out;
  for (const Coupling& one : all) {
    if (!is_leak(one, all) && out.size() < kMostCouplings) out.push_back(one);
  }
  return out;
}

struct SharedMotion {
  std::optional<Suggestion> with;  // the coupling
  double gain = 0.0;
  double log_p = 0.0;
};

// Couplings that take a witness as one does, sought again beside the noise: which frequencies count
// depends on it.
Suggestions like(const Suggestion& one, const Suggestions& sought) {
  const std::string& witness = std::get<EffectTerm>(one.added).witness;
  Suggestions out{one};
  for (const Suggestion& other : sought) {
    if (other.coupling == one.coupling && other.score_nats > 0.0 &&
        std::get<EffectTerm>(other.added).witness == witness)
      out.push_back(other);
  }
  return out;
}

SharedMotion shared_motion(const TriedTerm& noise, const std::vector<Coupling>& vibrations) {
  const Current with = current_of(noise.fitted.regression, noise.fitted.fit);
  if (vibrations.empty()) return {};
  const Effect* const coupling = vibrations.front().tried->term()->effect;
  const Suggestions sought = search_effects(with, {&coupling, 1});
  std::vector<SharedMotion> all;
  std::vector<double> noise_dof;
  for (const Coupling& one : vibrations) {
    for (Suggestion& how : like(one.tried->suggestion, sought)) {
      auto& term = std::get<EffectTerm>(how.added);
      term = rounded(std::move(term), how.shape_error, with.subject().rate);
      all.push_back({std::move(how)});
      noise_dof.push_back(one.tried->noise_dof);
    }
  }
  for_each_index(all.size(), [&](std::size_t i) {
    const Suggestion& how = *all[i].with;
    all[i].gain = fit_with(with, how).fit.log_likelihood - with.fit.log_likelihood;
    all[i].log_p = log_p_value(all[i].gain, how.dof, noise_dof[i], how.power, how.search);
  });
  const auto best = std::min_element(
      all.begin(), all.end(),
      [](const SharedMotion& a, const SharedMotion& b) { return a.log_p < b.log_p; });
  return best->log_p < 0.0 ? std::move(*best) : SharedMotion();
}

// Makes noise and a coupling one suggestion, with the evidence of both.
void join(TriedTerm& noise, const Suggestion& coupling, FittedModel both, double gain,
          double log_p) {
  const auto& term = std::get<EffectTerm>(coupling.added);
  auto& change = std::get<NoiseChange>(noise.suggestion.added);
  change.start = both.fit.model.noise;
  change.shared = term;
  noise.fitted = std::move(both);
  noise.cause = coupling.cause;
  noise.shared_with = term.witness;
  if (coupling.coupling != MotionCoupling::kTurning && may_leak(noise.fitted))
    noise.could_be.push_back("cross_axis");
  noise.likelihood_gain += gain;
  noise.log_p += log_p;
  noise.gain = -noise.log_p;
}

// Whether noise explains more than a coupling to this witness does alone.
bool needs_noise(const FittedModel& both, const std::string& witness,
                 const std::vector<TriedTerm>& tried) {
  constexpr double kNeeded = 6.0;  // nats: two parameters gain them by chance once in 400
  return std::all_of(tried.begin(), tried.end(), [&](const TriedTerm& one) {
    const bool alone = one.suggestion.coupling != MotionCoupling::kNone && one.term() != nullptr &&
                       one.term()->witness == witness;
    return !alone || both.fit.log_likelihood > one.fitted.fit.log_likelihood + kNeeded;
  });
}

// What of a motion another sensor does not show, because its own noise hides it there, is noise
// beside the coupling.
void add_hidden_part(std::vector<TriedTerm>& tried, const std::vector<Coupling>& vibrations,
                     double level, const std::vector<std::string>& refuted) {
  constexpr double kMisfits = 1e-3;
  // Nothing but noise with a coupling may be better.
  const auto best = std::find_if(tried.begin(), tried.end(),
                                 [](const TriedTerm& one) { return one.shared_with.empty(); });
  if (best == tried.end() || vibrations.empty() || vibrations.front().tried != &*best) return;
  const TriedTerm& coupling = *best;
  if (!(misfit_of(coupling.fitted).spectrum.p_value < kMisfits)) return;
  const Current with = current_of(coupling.fitted.regression, coupling.fitted.fit);
  Suggestions all = search_noise(with);
  const double least = std::log(level / static_cast<double>(all.size()));
  std::erase_if(all, [&](const Suggestion& one) {
    return std::find(refuted.begin(), refuted.end(), one.cause) != refuted.end();
  });
  std::vector<TriedTerm> noises = try_all(with, all);
  std::erase_if(noises, [](const TriedTerm& one) { return !cause_info(one.cause).by_spectrum; });
  if (noises.empty() || !(noises.front().log_p < least)) return;
  TriedTerm& noise = noises.front();
  FittedModel both = std::move(noise.fitted);
  join(noise, coupling.suggestion, std::move(both), coupling.likelihood_gain, coupling.log_p);
  tried.push_back(std::move(noise));
}

}  // namespace

void name_shared_noise(std::vector<TriedTerm>& tried, double searches, double level,
                       const std::vector<std::string>& refuted, const Progress& progress) {
  const double surely_there = std::log(level / searches);
  const double surely_shared = std::log(level / (kMostNoises * kMostCouplings));
  const std::vector<Coupling> vibrations = motions(tried);
  std::vector<std::pair<TriedTerm*, SharedMotion>> found;
  std::size_t looked = 0;
  for (TriedTerm& one : tried) {
    if (!cause_info(one.cause).by_spectrum || !(one.log_p < surely_there)) continue;
    if (looked++ == kMostNoises || progress.stopped()) break;
    const SharedMotion shared = shared_motion(one, vibrations);
    if (shared.log_p < surely_shared && shared.gain > kLeastShare * one.likelihood_gain)
      found.emplace_back(&one, shared);
  }
  for (const auto& [one, shared] : found) {
    const Current with = current_of(one->fitted.regression, one->fitted.fit);
    FittedModel both = fit_with(with, *shared.with);
    if (needs_noise(both, std::get<EffectTerm>(shared.with->added).witness, tried))
      join(*one, *shared.with, std::move(both), shared.gain, shared.log_p);
  }
  best_first(tried);
  if (!progress.stopped()) add_hidden_part(tried, motions(tried), level, refuted);
  best_first(tried);
}

}  // namespace imunoise
