#include "core/diagnosis/diagnose.h"

#include <algorithm>
#include <cmath>

#include "core/diagnosis/catalogue.h"
#include "core/diagnosis/outliers.h"
#include "core/diagnosis/shared_noise.h"
#include "core/diagnosis/two_levels.h"
#include "core/support/distributions.h"

namespace imunoise {
namespace {

constexpr double kClearGap = 3.0;      // nats: less cannot tell two effects apart
constexpr std::size_t kProven = 3;     // effects are proven on held-out replicates,
constexpr std::size_t kMostTried = 8;  // of at most so many that are tried
constexpr double kSpent = 0.8;         // of the level: chances are approximations
constexpr double kMisfitShare = 0.2;   // of that is spent on misfits of unknown cause

void add_unique(std::vector<std::string>& to, std::string_view id, const std::string& self) {
  if (id != self && std::find(to.begin(), to.end(), id) == to.end()) to.emplace_back(id);
}

// Two effects whose evidence is alike are rivals if the one leaves little for the other to explain;
// else both are there.
bool rivals(const RankedEffect& one, const RankedEffect& other, double significant) {
  if (std::abs(one.tried.gain - other.tried.gain) >= kClearGap) return false;
  if (other.familywise_p > significant || one.familywise_p > significant) return true;
  // A regressor can be added to either; two noises are each a change of the whole model.
  const bool regressor = std::holds_alternative<EffectTerm>(other.tried.suggestion.added);
  const RankedEffect& second = regressor ? other : one;
  const RankedEffect& first = regressor ? one : other;
  if (std::holds_alternative<NoiseChange>(second.tried.suggestion.added)) return true;
  const Current with = current_of(first.tried.trial.regression, first.tried.trial.fit);
  const double both = try_out(with, second.tried.suggestion).fit.log_likelihood;
  return both - with.fit.log_likelihood < 0.5 * second.tried.likelihood_gain;
}

// Would it show if there were a third level half-way? Of three that are visited alike two explain
// three quarters. The rest, a third of what they explain under the noise that they leave, must pay
// for its jumps as the others do; else noise that walks hides it.
bool levels_show(const TriedEffect& effect) {
  constexpr double kThird = 1.0 / 3.0;
  const auto* term = std::get_if<EffectTerm>(&effect.suggestion.added);
  if (term == nullptr || term->kind != EffectKind::kTelegraph) return true;
  const Regression& regression = effect.trial.regression;
  const Eigen::Index at = regression.first(regression.effects().size() - 1);
  const EffectCoefficients& found = effect.trial.fit.effects;
  const double explained = 0.5 * found.value(at) * found.value(at) / found.covariance(at, at);
  return kThird * explained > effect.suggestion.search.log_places;
}

// Candidates whose evidence is as good, and what was not recorded.
void fill_confusions(std::vector<RankedEffect>& effects, const Subject& subject,
                     double significant) {
  const std::vector<std::string_view> unrecorded = unrecorded_couplings(subject);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    RankedEffect& one = effects[i];
    for (const RankedEffect& other : effects) {
      if (effect_info(one.tried.effect).family == effect_info(other.tried.effect).family) continue;
      // Whether both are there is asked of the best one only: it costs a fit.
      const bool alike = i == 0 ? rivals(one, other, significant)
                                : std::abs(one.tried.gain - other.tried.gain) < kClearGap;
      if (alike) add_unique(one.confused_with, other.tried.effect, one.tried.effect);
    }
    for (const std::string_view id : unrecorded) {
      const bool could = id == "temperature" ? one.tried.slow : told_by_spectrum(one.tried.effect);
      if (could) add_unique(one.confused_with, id, one.tried.effect);
    }
    if (!levels_show(one.tried)) add_unique(one.confused_with, "step", one.tried.effect);
    if (one.tried.suggestion.backwards)
      add_unique(one.confused_with, "gauss_markov", one.tried.effect);
  }
}

// Replicates that were not used must become more likely. The error is told but does not judge:
// where it is at its floor already, chance moves it either way.
bool proven(const RankedEffect& effect, const std::optional<Errors>& before) {
  if (!effect.heldout || !before) return true;
  return effect.heldout->total_likelihood() > before->total_likelihood();
}

// Holds replicates out for the best effects, until enough of them are proven. The best of those
// comes first: evidence that other replicates do not bear out is no evidence.
void prove(Diagnosis& out, double level, const Progress& progress) {
  std::size_t tried = 0;
  std::size_t passed = 0;
  for (; tried < out.effects.size() && passed < kProven && tried < kMostTried; ++tried) {
    RankedEffect& one = out.effects[tried];
    if (progress.stopped() || (tried >= kProven && !(one.familywise_p < level))) break;
    if (can_hold_out(one.tried.trial)) one.heldout = heldout_errors(one.tried.trial);
    if (proven(one, out.heldout)) ++passed;
  }
  const auto end = out.effects.begin() + static_cast<std::ptrdiff_t>(tried);
  const auto best = std::find_if(out.effects.begin(), end, [&](const RankedEffect& one) {
    return one.familywise_p < level && proven(one, out.heldout);
  });
  if (best != end) std::rotate(out.effects.begin(), best, best + 1);
}

std::string parameter_of(const Suggestion& one) {
  const auto* term = std::get_if<EffectTerm>(&one.added);
  if (term == nullptr) return "power";
  switch (term->kind) {
    case EffectKind::kRamp:
      return "slope";
    case EffectKind::kStep:
      return "height";
    case EffectKind::kLine:
    case EffectKind::kWarmUp:
      return "amplitude";
    default:
      return "coefficient";
  }
}

// How large the coefficient of a search must be to pass the threshold nine times in ten.
std::optional<DetectionLimit> limit_of(const Suggestion& one, double level, Hertz rate) {
  if (!(one.information > 0.0)) return std::nullopt;
  const double needed = gain_needed(level, one.dof, one.power, one.search);
  const double nine_in_ten = normal_quantile(0.9);
  DetectionLimit out{std::string(one.effect), one.added, parameter_of(one),
                     (std::sqrt(2.0 * needed) + nine_in_ten) / std::sqrt(one.information)};
  if (auto* term = std::get_if<EffectTerm>(&out.added))
    *term = rounded(*term, one.shape_error, rate);
  return out;
}

}  // namespace

Diagnosis diagnose(const Trial& model, const DiagnosisOptions& options, const Progress& progress) {
  const Current current = current_of(model.regression, model.fit);
  const Subject& subject = current.subject();
  Suggestions all;
  const std::vector<Suggestions (*)(const Current&)> searches{
      scan_noise, scan_lines, scan_steps, scan_trends, scan_witnesses, scan_samples};
  double done = 0.0;
  for (const auto search : searches) {
    if (progress.stopped()) return {};
    Suggestions found = search(current);
    all.insert(all.end(), std::make_move_iterator(found.begin()),
               std::make_move_iterator(found.end()));
    done += 1.0 / static_cast<double>(searches.size());
    progress.report(0.4 * done);
  }
  const double misfit_level = kSpent * kMisfitShare * options.level;
  const double level = kSpent * options.level - misfit_level;
  // Everything that was searched is a chance of a false alarm.
  const auto searched = static_cast<double>(all.size());
  std::vector<TriedEffect> tried = try_all(current, all, progress.part(0.4, 0.75));
  name_shared_noise(tried, searched, level, progress);
  if (progress.stopped()) return {};
  Diagnosis out;
  for (TriedEffect& one : tried) {
    const double chance = std::min(1.0, searched * std::exp(one.log_chance));
    out.effects.push_back({std::move(one), chance, {}, {}});
  }
  out.misfit = misfit_of(model);
  out.misfit_p = misfit_p_value(out.misfit);
  progress.report(0.85);
  if (can_hold_out(model)) {
    out.heldout = heldout_errors(model);
    prove(out, level, progress);
    if (progress.stopped()) return {};
  }
  fill_confusions(out.effects, subject, level);
  progress.report(1.0);
  for (const Suggestion& one : all) {
    if (auto limit = limit_of(one, level / static_cast<double>(all.size()), subject.rate))
      out.limits.push_back(std::move(*limit));
  }
  out.worth_adding = !out.effects.empty() && out.effects[0].familywise_p < level &&
                     proven(out.effects[0], out.heldout);
  if (out.worth_adding) {
    const Trial& best = out.effects[0].tried.trial;
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

Trial fit_full_model(std::shared_ptr<const Subject> subject, const FullModel& start,
                     const Progress& progress) {
  Regression regression(std::move(subject));
  bool telegraph = false;
  for (const EffectTerm& term : start.effects) {
    if (term.kind == EffectKind::kTelegraph) {
      telegraph = true;
    } else {
      regression = regression.with(term);
    }
  }
  JointFit fit = joint_fit(regression, start.noise, progress);
  for (const EffectTerm& term : start.effects) {
    if (term.kind != EffectKind::kOutliers) continue;
    const Current current = current_of(regression, fit);
    regression = regression.on(without(regression.subject(), find_outliers(current, term.above)));
    fit = joint_fit(regression, fit.model.noise, progress);
  }
  if (telegraph) return with_two_levels(regression, fit);
  return {std::move(regression), std::move(fit)};
}

}  // namespace imunoise
