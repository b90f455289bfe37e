#include "core/diagnosis/diagnose.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "core/diagnosis/causes.h"
#include "core/diagnosis/missing_noise.h"
#include "core/diagnosis/placebo.h"
#include "core/diagnosis/shared_noise.h"
#include "core/effects/couplings.h"
#include "core/effects/known_effects.h"
#include "core/search/search_view.h"
#include "core/support/distributions.h"

namespace imunoise {
namespace {

constexpr double kClearGap = 3.0;      // nats: less cannot tell two effects apart
constexpr std::size_t kProven = 3;     // effects are proven on held-out replicates (climbing: 1),
constexpr std::size_t kMostTried = 8;  // of at most so many that are tried
constexpr double kSpent = 0.8;         // of the level: chances are approximations
constexpr double kMisfitShare = 0.2;   // of that is spent on misfits of unknown cause

void add_unique(std::vector<std::string>& to, std::string_view id, const std::string& self) {
  if (id != self && std::find(to.begin(), to.end(), id) == to.end()) to.emplace_back(id);
}

// Two effects whose evidence is alike are rivals if the one leaves little for the other to explain;
// else both are there.
bool rivals(const RankedTerm& one, const RankedTerm& other, double significant) {
  if (std::abs(one.tried.gain - other.tried.gain) >= kClearGap) return false;
  if (other.familywise_p > significant || one.familywise_p > significant) return true;
  // A regressor can be added to either; two noises are each a change of the whole model.
  const bool regressor = other.tried.term() != nullptr;
  const RankedTerm& second = regressor ? other : one;
  const RankedTerm& first = regressor ? one : other;
  if (second.tried.term() == nullptr) return true;
  const Current with = current_of(first.tried.fitted.regression, first.tried.fitted.fit);
  const double both = fit_with(with, second.tried.suggestion).fit.log_likelihood;
  return both - with.fit.log_likelihood < 0.5 * second.tried.likelihood_gain;
}

// What rings is mechanical: of all that may couple in, only motion does.
bool rings(const TriedTerm& tried) { return tried.cause == "resonance"; }

// Candidates whose evidence is as good, and what was not recorded.
void fill_confusions(std::vector<RankedTerm>& effects, const Subject& subject, double significant) {
  const std::vector<std::string_view> unrecorded = unrecorded_couplings(subject);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    RankedTerm& one = effects[i];
    for (const RankedTerm& other : effects) {
      if (cause_info(one.tried.cause).family == cause_info(other.tried.cause).family) continue;
      // Whether both are there is asked of the best one only: it costs a fit.
      const bool alike = i == 0 ? rivals(one, other, significant)
                                : std::abs(one.tried.gain - other.tried.gain) < kClearGap;
      if (alike) add_unique(one.confused_with, other.tried.cause, one.tried.cause);
    }
    for (const std::string_view id : unrecorded) {
      const bool could = id == "temperature" ? one.tried.slow
                                             : cause_info(one.tried.cause).by_spectrum &&
                                                   (is_motion(id) || !rings(one.tried));
      if (could) add_unique(one.confused_with, id, one.tried.cause);
    }
    for (const std::string_view id : one.tried.could_be)
      add_unique(one.confused_with, id, one.tried.cause);
  }
}

// Replicates that were not used must become more likely.
bool proven(const RankedTerm& effect, const std::optional<HeldOut>& before) {
  if (!effect.heldout || !before) return true;
  return effect.heldout->total_likelihood() > before->total_likelihood();
}

// Holds replicates out for the best effects, until enough of them are proven. The best of those
// comes first: evidence that other replicates do not bear out is no evidence.
void prove(Diagnosis& out, double level, std::size_t wanted, const Progress& progress) {
  std::size_t tried = 0;
  std::size_t passed = 0;
  for (; tried < out.effects.size() && passed < wanted && tried < kMostTried; ++tried) {
    RankedTerm& one = out.effects[tried];
    if (progress.stopped() || (tried >= wanted && !(one.familywise_p < level))) break;
    if (can_hold_out(one.tried.fitted)) one.heldout = held_out(one.tried.fitted);
    if (proven(one, out.heldout)) ++passed;
  }
  const auto end = out.effects.begin() + static_cast<std::ptrdiff_t>(tried);
  const auto best = std::find_if(out.effects.begin(), end, [&](const RankedTerm& one) {
    return one.familywise_p < level && proven(one, out.heldout);
  });
  if (best != end) std::rotate(out.effects.begin(), best, best + 1);
}

// How large the coefficient of a search must be to pass the threshold nine times in ten.
std::optional<DetectionLimit> limit_of(const Suggestion& one, double level, Hertz rate) {
  if (!(one.information > 0.0)) return std::nullopt;
  const double needed = gain_needed(level, one.dof, one.power, one.search);
  const double nine_in_ten = normal_quantile(0.9);
  DetectionLimit out{std::string(one.cause), one.added, "power",
                     (std::sqrt(2.0 * needed) + nine_in_ten) / std::sqrt(one.information)};
  if (auto* term = std::get_if<EffectTerm>(&out.added)) {
    *term = rounded(*term, one.shape_error, rate);
    out.parameter = term->effect->coefficient;
  }
  return out;
}

// What these effects explain.
Suggestions search_effects(const Current& current, std::span<const Effect* const> effects,
                           const Progress& progress) {
  Suggestions out;
  const SearchView view(current);
  for (std::size_t i = 0; i < effects.size() && !progress.stopped(); ++i) {
    progress.report(static_cast<double>(i) / static_cast<double>(effects.size()));
    if (effects[i]->search == nullptr) continue;
    Suggestions found = effects[i]->search(view);
    std::move(found.begin(), found.end(), std::back_inserter(out));
  }
  return out;
}

// Noise, then each effect.
Suggestions search_all(const Current& current, const Progress& progress) {
  Suggestions out = search_noise(current);
  Suggestions effects = search_effects(current, known_effects(), progress.part(0.1, 1.0));
  std::move(effects.begin(), effects.end(), std::back_inserter(out));
  return out;
}

// What was searched, and what of it is worth a trial.
struct Sought {
  double searches = 0.0;
  Suggestions wanted;
};

// The beginnings of the replicates, an eighth of a long recording, say what may well be added next;
// only that is sought in the whole.
Sought sought_by_beginnings(const Current& current, double level, const Progress& progress) {
  constexpr Eigen::Index kSamples = 1 << 20;  // of all replicates together
  constexpr std::size_t kMostWanted = 3;
  constexpr double kFarLess = 0.5;
  const auto count = static_cast<Eigen::Index>(current.subject().replicates());
  const Regression part = current.regression.beginnings(kSamples / count);
  const JointFit fit =
      joint_fit(part, current.fit.model.noise, {}, Begin::kAnywhere, current.fit.own_noise);
  const Current begun = current_of(part, fit);
  const Suggestions all = search_all(begun, progress.part(0.0, 0.4));
  Sought out{.searches = static_cast<double>(all.size()), .wanted = {}};
  const std::vector<TriedTerm> tried = try_all(begun, all, progress.part(0.4, 0.8));
  std::vector<const Effect*> effects;
  for (std::size_t i = 0; i < std::min(kMostWanted, tried.size()); ++i) {
    const TriedTerm& one = tried[i];
    const bool chance = one.log_p + std::log(out.searches) > std::log(level);
    if (chance || one.gain < kFarLess * tried.front().gain) break;
    const EffectTerm* const term = one.term();
    if (term == nullptr) {
      out.wanted.push_back(one.suggestion);
    } else if (std::find(effects.begin(), effects.end(), term->effect) == effects.end()) {
      effects.push_back(term->effect);
    }
  }
  Suggestions found = search_effects(current, effects, progress.part(0.8, 1.0));
  std::move(found.begin(), found.end(), std::back_inserter(out.wanted));
  return out;
}

}  // namespace

Diagnosis diagnose(const FittedModel& model, const DiagnosisOptions& options,
                   const Progress& progress) {
  const Current current = current_of(model.regression, model.fit);
  const Subject& subject = current.subject();
  const double misfit_level = kSpent * kMisfitShare * options.level;
  const double level = kSpent * options.level - misfit_level;
  Sought sought;
  if (options.climbing) {
    sought = sought_by_beginnings(current, level, progress.part(0.0, 0.4));
    if (sought.wanted.empty()) return diagnose(model, {options.level}, progress);
  } else {
    sought.wanted = search_all(current, progress.part(0.0, 0.4));
    sought.searches = static_cast<double>(sought.wanted.size());
  }
  if (progress.stopped()) return {};
  // Everything that was searched is a chance of a false alarm.
  const double searched = sought.searches;
  std::vector<TriedTerm> tried = try_all(current, sought.wanted, progress.part(0.4, 0.75));
  test_placebos(tried, current, std::log(level / searched), progress);
  name_shared_noise(tried, searched, level, progress);
  if (progress.stopped()) return {};
  Diagnosis out;
  for (TriedTerm& one : tried) {
    const double chance = std::min(1.0, searched * std::exp(one.log_p));
    out.effects.push_back({std::move(one), chance, {}, {}});
  }
  out.misfit = misfit_of(model);
  out.misfit_p = misfit_p_value(out.misfit);
  progress.report(0.85);
  if (can_hold_out(model)) {
    out.heldout = held_out(model);
    prove(out, level, options.climbing ? 1 : kProven, progress);
    if (progress.stopped()) return {};
  }
  fill_confusions(out.effects, subject, level);
  progress.report(1.0);
  for (const Suggestion& one : sought.wanted) {
    if (auto limit = limit_of(one, level / searched, subject.rate))
      out.limits.push_back(std::move(*limit));
  }
  out.worth_adding = !out.effects.empty() && out.effects[0].familywise_p < level &&
                     proven(out.effects[0], out.heldout);
  if (!out.worth_adding && options.climbing) return diagnose(model, {options.level}, progress);
  if (out.worth_adding) {
    const FittedModel& best = out.effects[0].tried.fitted;
    // What remains after the best effect must be small against what it took away, or it is not it.
    const MisfitReport after = misfit_of(best);
    const bool explains = !(after.spectrum.p_value < 1e-6) ||
                          after.spectrum.statistic < 0.5 * out.misfit.spectrum.statistic;
    if (!explains || !out.effects[0].tried.steady) {
      out.verdict = DiagnosisVerdict::kUnknown;
    } else {
      out.verdict = out.effects[0].confused_with.empty() ? DiagnosisVerdict::kFound
                                                         : DiagnosisVerdict::kOneOf;
    }
  } else if (out.misfit_p < misfit_level) {
    out.verdict = DiagnosisVerdict::kUnknown;
  }
  return out;
}

}  // namespace imunoise
