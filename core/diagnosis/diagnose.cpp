#include "core/diagnosis/diagnose.h"

#include <algorithm>
#include <cmath>

#include "core/diagnosis/candidates.h"
#include "core/diagnosis/causes.h"
#include "core/diagnosis/placebo.h"
#include "core/diagnosis/searches.h"
#include "core/diagnosis/shared_noise.h"
#include "core/effects/couplings/couplings.h"
#include "core/support/distributions.h"

namespace imunoise {
namespace {

constexpr double kClearGap = 3.0;      // nats: less cannot tell two effects apart
constexpr std::size_t kProven = 3;     // effects are proven on held-out replicates,
constexpr std::size_t kMostTried = 8;  // of at most so many that are tried

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

// What is not there all the time has no name, but for a vibration that may switch on and off.
bool switches(const RankedTerm& one) {
  const auto& could_be = one.tried.could_be;
  return std::find(could_be.begin(), could_be.end(), "switched_line") != could_be.end();
}

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

// Holds replicates out for the best effects, until enough of them are proven. The best of those
// comes first: evidence that other replicates do not bear out is no evidence.
void prove(Diagnosis& out, double level, const Progress& progress) {
  std::size_t tried = 0;
  std::size_t passed = 0;
  for (; tried < out.effects.size() && passed < kProven && tried < kMostTried; ++tried) {
    RankedTerm& one = out.effects[tried];
    if (progress.stopped() || (tried >= kProven && !(one.familywise_p < level))) break;
    hold_out(one);
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
  DetectionLimit out{std::string(one.cause),
                     one.added,
                     {},
                     (std::sqrt(2.0 * needed) + nine_in_ten) / std::sqrt(one.information)};
  if (auto* term = std::get_if<EffectTerm>(&out.added)) {
    *term = rounded(*term, one.shape_error, rate);
    out.parameter = term->effect->coefficient;
  } else {
    out.parameter = parameters(std::get<NoiseChange>(one.added).added)[0].name;
  }
  return out;
}

}  // namespace

Diagnosis diagnose(const FittedModel& model, double false_alarm, const Progress& progress) {
  const Current current = current_of(model.regression, model.fit);
  const Subject& subject = current.subject();
  const Levels levels = levels_of(false_alarm);
  const double level = levels.term;
  const Suggestions sought = search_all(current, progress.part(0.0, 0.4));
  if (progress.stopped()) return {};
  // Everything that was searched is a chance of a false alarm.
  const auto searched = static_cast<double>(sought.size());
  std::vector<TriedTerm> tried = try_all(current, sought, progress.part(0.4, 0.75));
  test_placebos(tried, current, std::log(level / searched), Placebos::kAll, progress);
  name_shared_noise(tried, searched, level, {}, progress);
  if (progress.stopped()) return {};
  Diagnosis out;
  out.searches = searched;
  for (TriedTerm& one : tried) out.effects.push_back(ranked(std::move(one), searched));
  out.misfit = misfit_of(model);
  out.misfit_p = misfit_p_value(out.misfit);
  progress.report(0.85);
  out.heldout = held_out(model);
  if (out.heldout) prove(out, level, progress);
  if (progress.stopped()) return {};
  fill_confusions(out.effects, subject, level);
  progress.report(1.0);
  for (const Suggestion& one : sought) {
    if (auto limit = limit_of(one, level / searched, subject.rate))
      out.limits.push_back(std::move(*limit));
  }
  out.worth_adding = !out.effects.empty() && out.effects[0].familywise_p < level &&
                     proven(out.effects[0], out.heldout);
  if (out.worth_adding) {
    const FittedModel& best = out.effects[0].tried.fitted;
    // What remains after the best effect must be small against what it took away, or it is not it.
    const MisfitReport after = misfit_of(best);
    const bool explains = !(after.spectrum.p_value < 1e-6) ||
                          after.spectrum.statistic < 0.5 * out.misfit.spectrum.statistic;
    if (!explains || !(out.effects[0].tried.steady || switches(out.effects[0]))) {
      out.verdict = DiagnosisVerdict::kUnknown;
    } else {
      out.verdict = out.effects[0].confused_with.empty() ? DiagnosisVerdict::kFound
                                                         : DiagnosisVerdict::kOneOf;
    }
  } else if (out.misfit_p < levels.misfit) {
    out.verdict = DiagnosisVerdict::kUnknown;
  }
  return out;
}

}  // namespace imunoise
