#include "core/diagnosis/shared_noise.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/diagnosis/causes.h"
#include "core/effects/couplings.h"

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

struct SharedMotion {
  const TriedTerm* with = nullptr;  // the coupling; null: none
  double gain = 0.0;
  double log_p = 0.0;
};

SharedMotion shared_motion(const TriedTerm& noise, const std::vector<Coupling>& vibrations) {
  const Current with = current_of(noise.fitted.regression, noise.fitted.fit);
  SharedMotion out;
  for (const Coupling& one : vibrations) {
    const Suggestion& how = one.tried->suggestion;
    const double gain = fit_with(with, how).fit.log_likelihood - with.fit.log_likelihood;
    const double log_p = log_p_value(gain, how.dof, one.tried->noise_dof, how.power, how.search);
    if (log_p < out.log_p) out = {one.tried, gain, log_p};
  }
  return out;
}

}  // namespace

void name_shared_noise(std::vector<TriedTerm>& tried, double searches, double level,
                       const Progress& progress) {
  const double surely_there = std::log(level / searches);
  const double surely_shared = std::log(level / (kMostNoises * kMostCouplings));
  const std::vector<Coupling> all = couplings(tried);
  std::vector<Coupling> vibrations;
  for (const Coupling& one : all) {
    if (!is_leak(one, all) && vibrations.size() < kMostCouplings) vibrations.push_back(one);
  }
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
    const EffectTerm& coupling = *shared.with->term();
    const Current with = current_of(one->fitted.regression, one->fitted.fit);
    auto& noise = std::get<NoiseChange>(one->suggestion.added);
    FittedModel both = fit_with(with, shared.with->suggestion);
    noise.start = both.fit.model.noise;
    noise.shared = coupling;
    one->fitted = std::move(both);
    const bool turning = shared.with->suggestion.coupling == MotionCoupling::kTurning;
    one->cause = turning ? "tilt" : "common_vibration";
    one->shared_with = coupling.witness;
    one->likelihood_gain += shared.gain;
    one->log_p += shared.log_p;
    one->gain = -one->log_p;
  }
  best_first(tried);
}

}  // namespace imunoise
