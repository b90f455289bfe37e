#include "core/diagnosis/climb.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/diagnosis/candidates.h"
#include "core/diagnosis/missing_noise.h"
#include "core/diagnosis/placebo.h"
#include "core/diagnosis/searches.h"
#include "core/diagnosis/shared_noise.h"
#include "core/effects/known_effects.h"

namespace imunoise {
namespace {

constexpr std::size_t kMostProofs = 8;  // candidates of a rung that may try to prove themselves
constexpr double kStillThere = 0.5;     // of what a lead explained at the last look

// The cause that a search names, and the witness.
std::string found_by(const Suggestion& one) {
  const auto* const term = std::get_if<EffectTerm>(&one.added);
  return std::string(one.cause) + (term == nullptr ? "" : " " + term->witness);
}

const Effect* effect_of(const Suggestion& one) {
  const auto* const term = std::get_if<EffectTerm>(&one.added);
  return term == nullptr ? nullptr : term->effect;
}

bool is_coupling(const Suggestion& one) { return one.coupling != MotionCoupling::kNone; }

bool contains(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

void add_unique(std::vector<const Effect*>& to, const Effect* one) {
  if (std::find(to.begin(), to.end(), one) == to.end()) to.push_back(one);
}

void append(Suggestions& to, Suggestions more) {
  std::move(more.begin(), more.end(), std::back_inserter(to));
}

// What a fit can hardly make enough of: it finds a part of what a search promises, or several times
// that.
void erase_hopeless(Suggestions& all, double least) {
  constexpr double kHopeless = 0.1;
  std::erase_if(all, [&](const Suggestion& one) { return promised(one) < -kHopeless * least; });
}

Eigen::Index samples_of(const Subject& subject) {
  Eigen::Index out = 0;
  for (std::size_t k = 0; k < subject.replicates(); ++k) out += subject.length(k);
  return out;
}

}  // namespace

// The model of a rung, and what is asked of a term beside it.
struct Climb::Look {
  const Current& current;
  const std::optional<HeldOut>& heldout;
  double searches = 0.0;  // that were made

  double least(const Levels& levels) const { return std::log(levels.term / searches); }
};

Climb::Climb(const Diagnosis& first, const FittedModel& model, double level, Eigen::Index beginning)
    : levels_(levels_of(level)),
      beginning_(samples_of(model.regression.subject()) > 2 * beginning ? beginning : 0),
      searches_(first.searches) {
  for (const RankedTerm& one : first.effects) {
    if (one.familywise_p < levels_.term) follow(one.tried);
  }
  if (first.worth_adding) leave_behind(first.effects.front().tried);
}

void Climb::follow(const TriedTerm& one) {
  leads_.push_back({found_by(one.suggestion), effect_of(one.suggestion), one.gain});
}

void Climb::leave_behind(const TriedTerm& taken) {
  const std::string found = found_by(taken.suggestion);
  std::erase_if(leads_, [&](const Lead& one) {
    return one.found == found || one.evidence < kMasked * taken.gain;
  });
  // One more of its kind was seen already.
  if (taken.next_gain > 0.0)
    leads_.push_back({found, effect_of(taken.suggestion), taken.next_gain});
}

void Climb::refute(const Suggestion& one) {
  refuted_.push_back(found_by(one));
  std::erase_if(leads_, [&](const Lead& lead) { return lead.found == refuted_.back(); });
}

const Climb::Lead* Climb::lead_to(const Suggestion& one) const {
  const std::string found = found_by(one);
  const auto at = std::find_if(leads_.begin(), leads_.end(),
                               [&](const Lead& lead) { return lead.found == found; });
  return at == leads_.end() ? nullptr : &*at;
}

// The first of tried terms that proves itself; those that do not are refuted.
std::optional<RankedTerm> Climb::best_of(const Look& look, std::vector<TriedTerm> tried) {
  best_first(tried);
  std::size_t proofs = 0;
  for (TriedTerm& one : tried) {
    if (!(one.log_p < look.least(levels_))) continue;
    if (proofs++ == kMostProofs) break;
    RankedTerm out = ranked(std::move(one), look.searches);
    hold_out(out);
    if (proven(out, look.heldout)) return out;
    refute(out.tried.suggestion);
  }
  return std::nullopt;
}

std::vector<TriedTerm> Climb::tried(const Look& look, Suggestions wanted, const Progress& progress,
                                    bool thorough) const {
  if (!thorough) erase_hopeless(wanted, look.least(levels_));
  std::vector<TriedTerm> out = try_all(look.current, wanted, progress);
  test_placebos(out, look.current, look.least(levels_), Placebos::kSigns, progress);
  name_shared_noise(out, look.searches, levels_.term,
                    thorough ? std::vector<std::string>{} : refuted_, progress);
  return out;
}

// The beginnings of the replicates say what may well be added next; only that is sought in the
// whole.
std::optional<RankedTerm> Climb::by_beginnings(Look look, const Progress& progress) {
  constexpr std::size_t kMostWanted = 3;
  constexpr double kFarLess = 0.5;
  const Current& current = look.current;
  const auto count = static_cast<Eigen::Index>(current.subject().replicates());
  const Regression part = current.regression.beginnings(beginning_ / count);
  const JointFit fit =
      joint_fit(part, current.fit.model.noise, {}, Begin::kAnywhere, current.fit.own_noise);
  const Current begun = current_of(part, fit);
  Suggestions all = search_all(begun, progress.part(0.0, 0.4));
  look.searches = static_cast<double>(all.size());
  erase_hopeless(all, look.least(levels_));
  const std::vector<TriedTerm> promising = try_all(begun, all, progress.part(0.4, 0.8));
  Suggestions wanted;
  std::vector<const Effect*> effects;
  for (std::size_t i = 0; i < std::min(kMostWanted, promising.size()); ++i) {
    const TriedTerm& one = promising[i];
    if (!(one.log_p < look.least(levels_)) || one.gain < kFarLess * promising.front().gain) break;
    if (const Effect* const effect = effect_of(one.suggestion)) {
      add_unique(effects, effect);
    } else {
      wanted.push_back(one.suggestion);
    }
  }
  append(wanted, search_effects(current, effects, progress.part(0.8, 0.9)));
  return best_of(look, tried(look, std::move(wanted), progress.part(0.9, 1.0)));
}

std::optional<RankedTerm> Climb::by_leads(Look look, const Progress& progress) {
  look.searches = searches_;
  std::vector<const Effect*> effects;
  bool noise = false;
  for (const Lead& one : leads_) {
    noise = noise || one.effect == nullptr;
    if (one.effect != nullptr) add_unique(effects, one.effect);
  }
  // Another sensor may feel the noise, too.
  if (noise) add_unique(effects, &effect_named("witness"));
  Suggestions all = noise ? search_noise(look.current) : Suggestions{};
  append(all, search_effects(look.current, effects, progress.part(0.1, 0.6)));
  std::erase_if(all, [&](const Suggestion& one) {
    return effect_of(one) == nullptr && lead_to(one) == nullptr;
  });
  std::vector<TriedTerm> found = tried(look, std::move(all), progress.part(0.6, 0.9));
  // What explains far less than it did shows that the picture has changed.
  std::erase_if(found, [&](const TriedTerm& one) {
    const Lead* const lead = lead_to(one.suggestion);
    return lead != nullptr && one.gain < kStillThere * lead->evidence;
  });
  return best_of(look, std::move(found));
}

std::optional<RankedTerm> Climb::by_everything(Look look, const Progress& progress) {
  constexpr std::size_t kFew = 8;
  Suggestions all = search_all(look.current, progress.part(0.0, 0.5));
  searches_ = look.searches = static_cast<double>(all.size());
  const auto refuted = [&](const Suggestion& one) { return contains(refuted_, found_by(one)); };
  std::stable_sort(all.begin(), all.end(), [](const Suggestion& a, const Suggestion& b) {
    return promised(a) > promised(b);
  });
  // Those that promise most, with the couplings that noise may be shared by.
  Suggestions first;
  Suggestions later;
  for (Suggestion& one : all) {
    const bool now = !refuted(one) && (first.size() < kFew || is_coupling(one));
    (now ? first : later).push_back(std::move(one));
  }
  std::vector<TriedTerm> found = tried(look, std::move(first), progress.part(0.5, 0.7));
  leads_.clear();
  for (const TriedTerm& one : found) {
    if (one.log_p < look.least(levels_)) follow(one);
  }
  std::optional<RankedTerm> best = best_of(look, std::move(found));
  if (!best && !progress.stopped())
    best = best_of(look, tried(look, later, progress.part(0.7, 0.9), true));
  for (const Suggestion& one : later) {
    if (promised(one) > -look.least(levels_) && !refuted(one))
      leads_.push_back({found_by(one), effect_of(one), promised(one)});
  }
  std::erase_if(leads_, [&](const Lead& one) { return contains(refuted_, one.found); });
  return best;
}

NextTerm Climb::next(const FittedModel& model, const std::optional<HeldOut>& heldout,
                     const Progress& progress) {
  const Current current = current_of(model.regression, model.fit);
  NextTerm out;
  out.misfit = misfit_of(model);
  out.heldout = heldout ? heldout : held_out(model);
  const Look look{current, out.heldout};
  if (beginning_ > 0) {
    out.best = by_beginnings(look, progress.part(0.0, 0.2));
    if (!out.best) beginning_ = 0;
  }
  if (!out.best && !leads_.empty() && !progress.stopped()) {
    out.best = by_leads(look, progress.part(0.2, 0.4));
    if (!out.best) leads_.clear();
  }
  if (!out.best && !progress.stopped()) out.best = by_everything(look, progress.part(0.4, 1.0));
  if (out.best) {
    leave_behind(out.best->tried);
  } else if (misfit_p_value(out.misfit) < levels_.misfit) {
    out.verdict = DiagnosisVerdict::kUnknown;
  }
  return out;
}

}  // namespace imunoise
