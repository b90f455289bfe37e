#include "study/analysis/diagnosis_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/diagnosis/causes.h"
#include "core/diagnosis/views/run_off.h"
#include "core/effects/couplings/couplings.h"
#include "core/inference/normal_scores.h"
#include "study/analysis/effect_parameters.h"
#include "study/analysis/less_effects.h"
#include "study/analysis/noise_budget.h"
#include "study/analysis/sentences/error_sentences.h"
#include "study/analysis/vocabulary.h"
#include "study/words/number.h"

namespace imunoise::study {
namespace {

constexpr std::size_t kMostCandidates = 12;

v1::Verdict verdict_of(DiagnosisVerdict from) {
  switch (from) {
    case DiagnosisVerdict::kFound:
      return v1::found;
    case DiagnosisVerdict::kOneOf:
      return v1::one_of;
    case DiagnosisVerdict::kUnknown:
      return v1::unknown;
    case DiagnosisVerdict::kNone:
      break;
  }
  return v1::none;
}

// "tilt, sensitivity to acceleration or vibration of the bench".
std::string either(std::string_view first, const std::vector<std::string>& others) {
  std::string out(first);
  for (std::size_t i = 0; i < others.size(); ++i)
    out += fmt::format("{}{}", i + 1 == others.size() ? " or " : ", ", cause_info(others[i]).title);
  return out;
}

// "frequency 12.34 Hz, amplitude 3.2e-05 rad/s".
std::string numbers(const std::vector<v1::EffectParameter>& parameters) {
  constexpr std::size_t kMost = 3;
  std::string out;
  for (std::size_t i = 0; i < std::min(kMost, parameters.size()); ++i) {
    std::string name = parameters[i].name();
    for (const std::string_view suffix : {"_hz", "_s"}) {
      if (name.ends_with(suffix)) name.resize(name.size() - suffix.size());
    }
    std::replace(name.begin(), name.end(), '_', ' ');
    out += fmt::format("{}{} {}{}", out.empty() ? "" : ", ", name,
                       report::brief(parameters[i].value(), 4),
                       parameters[i].unit() == "1" ? "" : " " + parameters[i].unit());
  }
  return out;
}

const Cause& info_of(const TriedTerm& tried, const Subject& subject) {
  const EffectTerm* const term = tried.term();
  return cause_info(tried.cause, term == nullptr ? nullptr : subject.find(term->witness));
}

v1::EffectCandidate candidate_of(const RankedTerm& from, const std::optional<HeldOut>& before,
                                 const Subject& subject) {
  const TriedTerm& tried = from.tried;
  const Cause& about = info_of(tried, subject);
  v1::EffectCandidate to;
  to.set_effect(tried.cause);
  to.set_title(std::string(about.title));
  to.set_term(printed(tried.suggestion.added));
  if (tried.term() != nullptr) to.set_witness(tried.term()->witness);
  if (!tried.shared_with.empty()) to.set_witness(tried.shared_with);
  to.set_familywise_p(from.familywise_p);
  to.set_gain_nats(tried.gain);
  to.set_likelihood_gain_nats(tried.likelihood_gain);
  if (from.heldout && before) {
    to.set_heldout_gain_nats(from.heldout->total_likelihood() - before->total_likelihood());
  }
  const std::vector<v1::EffectParameter> parameters = effect_parameters(tried, subject);
  for (const v1::EffectParameter& one : parameters) *to.add_parameters() = one;
  for (const std::string& id : from.confused_with) to.add_confused_with(id);
  to.set_cause(std::string(about.physics));
  to.set_record_next(std::string(about.record_next));
  const std::string with = to.witness().empty() ? "" : fmt::format(" ({})", to.witness());
  const std::string told = numbers(parameters);
  std::string sentence = fmt::format("{}{}{}{}: explains {:.1f} nats", about.title, with,
                                     told.empty() ? "" : ", ", told, tried.likelihood_gain);
  if (to.has_heldout_gain_nats())
    sentence += fmt::format(", on held-out data {:.1f} nats", to.heldout_gain_nats());
  to.set_sentence(sentence + fmt::format(" ({}).", chance_words(from.familywise_p)));
  return to;
}

// What else to record so that an effect can be told from couplings to unrecorded quantities.
std::string beside(const RankedTerm& best, const Subject& subject) {
  const std::vector<std::string_view> unrecorded = unrecorded_couplings(subject);
  const bool some = std::any_of(unrecorded.begin(), unrecorded.end(), [&](std::string_view id) {
    return std::find(best.confused_with.begin(), best.confused_with.end(), id) !=
           best.confused_with.end();
  });
  return some ? " Also record all channels that could couple in." : "";
}

std::string summary_of(const Diagnosis& diagnosis, const Subject& subject) {
  if (diagnosis.verdict == DiagnosisVerdict::kNone)
    return "No effect is missing that these data could show; the limits say how strong each effect "
           "would have to be.";
  if (!diagnosis.worth_adding)
    return "The model fails, and no known effect explains it: see where it fails.";
  const RankedTerm& best = diagnosis.effects.front();
  const Cause& about = info_of(best.tried, subject);
  const std::string chance = chance_words(best.familywise_p);
  if (diagnosis.verdict == DiagnosisVerdict::kFound)
    return fmt::format("Missing: {} ({}). {}", about.title, chance, about.physics);
  if (diagnosis.verdict == DiagnosisVerdict::kOneOf)
    return fmt::format("An effect is missing: {}. These data cannot separate them. Record {}.{}",
                       either(about.title, best.confused_with), about.record_next,
                       beside(best, subject));
  return fmt::format(
      "Missing: {} ({}), but it does not explain everything. Add it and run the diagnosis "
      "again (--auto does this), and see where the model fails.",
      about.title, chance);
}

// "rad" for a rate.
std::string integral_unit(Quantity quantity) {
  switch (quantity) {
    case Quantity::kAngularRate:
      return "rad";
    case Quantity::kAcceleration:
      return "m/s";
    default:
      break;
  }
  const std::string_view unit = si_symbol(quantity);
  return unit.empty() ? "s" : fmt::format("{}·s", unit);
}

// Hz: slower waves are not sought.
double slowest_wave(const Effect& effect, const Subject& subject) {
  double longest = 0.0;
  for (std::size_t k = 0; k < subject.replicates(); ++k)
    longest = std::max(longest, subject.seconds(k));
  return effect.fewest_periods / longest;
}

}  // namespace

std::string printed(const AddedTerm& added) {
  if (const auto* term = std::get_if<EffectTerm>(&added)) return print(*term);
  const auto& change = std::get<NoiseChange>(added);
  const Model alone{{Term(change.added)}};
  return change.shared ? fmt::format("{} + {}", print(alone), print(*change.shared)) : print(alone);
}

// What a detection limit is of: of noise, its power at this shape.
std::string limited(const AddedTerm& added) {
  const auto* const change = std::get_if<NoiseChange>(&added);
  if (change == nullptr) return printed(added);
  Term term(change->added);
  std::vector<double> numbers = values(term.process);
  for (std::size_t p = 1; p < numbers.size(); ++p) {
    numbers[p] = std::stod(fmt::format("{:.6g}", numbers[p]));
    term.given[p] = true;
  }
  set_values(term.process, numbers);
  return print(Model{{std::move(term)}});
}

void add_diagnosis(const Diagnosis& diagnosis, const Subject& subject, v1::DiagnosisReport& to) {
  to.set_verdict(verdict_of(diagnosis.verdict));
  to.set_summary(summary_of(diagnosis, subject));
  for (std::size_t i = 0; i < std::min(kMostCandidates, diagnosis.effects.size()); ++i)
    *to.add_candidates() = candidate_of(diagnosis.effects[i], diagnosis.heldout, subject);
  for (const DetectionLimit& from : diagnosis.limits) {
    const bool prepared =
        std::any_of(diagnosis.effects.begin(), diagnosis.effects.end(), [&](const RankedTerm& one) {
          constexpr double kSeen = 0.01;
          return one.tried.cause == from.cause && one.familywise_p < kSeen;
        });
    if (prepared) continue;
    v1::DetectionLimit& limit = *to.add_limits();
    limit.set_effect(from.cause);
    limit.set_parameter(from.parameter);
    limit.set_value(from.value);
    const auto* term = std::get_if<EffectTerm>(&from.added);
    limit.set_unit(term != nullptr ? unit_of(*term, subject)
                                   : unit_of(Dimension::kPower, subject.quantity));
    if (term != nullptr && term->effect->witness) limit.set_witness(term->witness);
    const bool anywhere = term != nullptr && term->effect->anywhere;
    if (!anywhere) limit.set_term(limited(from.added));
    if (term != nullptr && term->effect->fewest_periods > 0.0)
      limit.set_lowest_hz(slowest_wave(*term->effect, subject));
  }
}

bool is_resonance(const v1::LadderFinding& one) { return one.effect() == "resonance"; }

// What a headline says of findings. Many resonances are one thing there: a filter, most likely.
std::string in_short(const v1::DiagnosisReport& report, bool filter) {
  const auto resonances =
      std::count_if(report.findings().begin(), report.findings().end(), is_resonance);
  std::string out;
  bool told = false;
  for (const v1::LadderFinding& one : report.findings()) {
    const bool together = filter && is_resonance(one);
    if (together && std::exchange(told, true)) continue;
    out += out.empty() ? "" : "; ";
    out += together ? fmt::format("{} resonances, which may together be one filter of unknown form",
                                  resonances)
                    : one.sentence();
  }
  return out;
}

void add_remaining(std::optional<DiagnosisVerdict> verdict, v1::DiagnosisReport& to) {
  constexpr auto kComb = 3;
  const auto resonances = std::count_if(to.findings().begin(), to.findings().end(), is_resonance);
  const bool filter = resonances >= kComb;
  if (filter)
    to.add_notes(fmt::format(
        "The {} resonances may together be one filter of a form that imunoise does not know, such "
        "as a notch or CIC filter. Record the same without the filter, or with "
        "another cutoff frequency: the resonances of a structure stay, those of a filter move.",
        resonances));
  const std::string all = in_short(to, filter);
  if (to.verdict() == v1::unknown && !all.empty()) {
    if (verdict == DiagnosisVerdict::kNone) to.set_verdict(v1::several);
    to.set_summary(fmt::format("Missing: {}.", all));
  } else if (!all.empty()) {
    to.set_summary(fmt::format("{} Found: {}.", to.summary(), all));
  }
  if (!verdict) {
    to.set_summary(
        to.summary() +
        " The ladder ends at its longest; go on from its last model with imunoise study.");
    return;
  }
  to.set_remaining(verdict_of(*verdict));
  const std::string_view left = *verdict == DiagnosisVerdict::kNone
                                    ? "no further effect is missing that these data could show"
                                    : "a misfit remains that no known effect explains";
  to.set_summary(fmt::format("{} Once {} in the model, {}.", to.summary(),
                             to.findings_size() > 1 ? "all of these are" : "that is", left));
}

v1::Rung rung_of(const EvaluatedModel& evaluated, const Step& step, double first,
                 const std::vector<std::string>& replicates) {
  const FittedModel& trial = evaluated.trial;
  v1::Rung out;
  out.set_model(print(trial.fit.model));
  out.set_added(step.added);
  out.set_effect(step.effect);
  for (const std::string& term : step.dropped) out.add_dropped(term);
  out.set_training_error(training_error(trial, evaluated.left));
  if (evaluated.heldout) {
    for (const double nats : evaluated.heldout->nats) out.add_heldout_nats(nats);
    for (const Eigen::Index samples : evaluated.heldout->samples)
      out.add_heldout_samples(static_cast<std::uint64_t>(samples));
    out.set_heldout_scores(static_cast<std::uint32_t>(evaluated.heldout->scores));
  }
  out.set_promised_nats(promised_nats(evaluated.misfit));
  for (v1::ErrorView& one : views_of(trial, evaluated.left, evaluated.misfit, replicates))
    *out.add_views() = std::move(one);
  out.set_fitted_model(print_with_values(FullModel{trial.fit.model.noise, sized_effects(trial)}));
  out.set_estimator(
      likelihood_estimator(moments_estimator(trial.regression.subject().replicates())));
  for (v1::FittedEffect& one : fitted_effects(trial)) *out.add_effects() = std::move(one);
  out.set_log_likelihood(trial.fit.log_likelihood - first);
  out.set_misfit_p(misfit_p_value(evaluated.misfit));
  out.set_why(step.why);
  const std::string unit = integral_unit(trial.regression.subject().quantity);
  for (const RunOff& from : evaluated.left.run_off) {
    v1::IntegratedError& drift = *out.add_drift();
    drift.set_seconds(from.seconds);
    drift.set_predicted(from.predicted);
    drift.set_measured(from.measured);
    drift.set_stretches(static_cast<std::uint64_t>(from.stretches));
    drift.set_unit(unit);
  }
  return out;
}

v1::NoiseBudget budget_of(const FittedModel& trial, const LeftOver& left) {
  const Model& noise = trial.fit.model.noise;
  const std::vector<WaveletVariance>& measured = left.variances;
  const PerReplicate<NormalScores> scores = normal_scores(noise, measured, left.covariances);
  std::vector<std::vector<bool>> tested;
  for (std::size_t k = 0; k < measured.size(); ++k) tested.push_back(scores[k].used());
  return noise_budget(noise, measured, left.covariances, tested, 0.95);
}

}  // namespace imunoise::study
