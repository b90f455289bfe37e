#include "study/analysis/diagnose_series.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/diagnosis/climb.h"
#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/missing_resonance.h"
#include "core/diagnosis/useless.h"
#include "core/effects/parse_full_model.h"
#include "core/model/similar_term.h"
#include "study/analysis/comparison.h"
#include "study/analysis/diagnosis_report.h"
#include "study/analysis/evaluate.h"
#include "study/analysis/integrity_report.h"
#include "study/analysis/less_effects.h"
#include "study/analysis/prepare.h"
#include "study/analysis/select_model.h"
#include "study/analysis/sentences/ladder_findings.h"
#include "study/analysis/sentences/misfit_sentences.h"
#include "study/analysis/series.h"
#include "study/analysis/unexplained.h"
#include "study/analysis/vocabulary.h"

namespace imunoise::study {
namespace {

constexpr int kMostRungs = 16;

Step step_of(const TriedTerm& tried) {
  return {.added = printed(tried.suggestion.added),
          .effect = tried.cause,
          .why = fmt::format("{} explains {:.1f} nats; its evidence against chance is {:.1f} nats.",
                             tried.cause, tried.likelihood_gain, tried.gain)};
}

// The noise that a term added, as it was fitted.
std::optional<Process> noise_of(const TriedTerm& tried) {
  const auto* const change = std::get_if<NoiseChange>(&tried.suggestion.added);
  if (change == nullptr) return std::nullopt;
  const Model& noise = tried.fitted.fit.model.noise;
  const auto term = similar_term(noise, change->added);
  return term ? std::optional(noise.terms[*term].process) : std::nullopt;
}

// Takes what the last term made useless out of a model, one after the other; see useless_term().
void drop_useless(FittedModel& model, Step& step, double level, const Model& kept) {
  while (auto useless = useless_term(model, level, kept)) {
    step.dropped.push_back(useless->term);
    step.why += fmt::format(" Beside it {} explains no more than chance ({:.1f} nats).",
                            useless->term, useless->loss);
    model = std::move(useless->without);
  }
}

// What a step says that leads back to a model of the same ladder.
std::string came_back(const Step& step) {
  std::string dropped;
  for (const std::string& term : step.dropped)
    dropped += fmt::format("{}{}", dropped.empty() ? "" : ", ", term);
  return fmt::format(
      "The ladder ends where it would go in circles: {} could be added, but beside it {} is no "
      "longer needed, and the model is one that was tried before.",
      step.added, dropped.empty() ? "nothing" : dropped);
}

// Works out what the ladder would show were one of the best candidates added, exactly as adding it
// does.
void forecast_rungs(const PreparedChannel& prepared, int count, const Progress& progress,
                    v1::DiagnosisReport& to) {
  for (v1::EffectCandidate& one : *to.mutable_candidates()) {
    if (count == 0 || progress.stopped()) return;
    if (one.term().empty()) continue;  // a defect of the samples
    --count;
    auto next = evaluate(fmt::format("{} + {}", to.model(), one.term()), prepared,
                         {.added = one.term(), .why = ""});
    if (next) *one.mutable_next() = std::move(*next);  // else the scales are too few for it
  }
}

std::string names_of(const std::vector<Witness>& witnesses) {
  std::string out;
  for (const Witness& one : witnesses)
    out += fmt::format("{}{}", out.empty() ? "" : ", ", one.name);
  return out;
}

}  // namespace

Result<std::string> model_for(const RecordedChannel& look, const Progress& progress) {
  return chosen_model(series_of(look.parts.replicates, look.channel), {}, progress);
}

Result<v1::DiagnosisReport> diagnose_series(const std::vector<recording::Replicate>& recorded,
                                            std::size_t channel, const DiagnoseOptions& options,
                                            const Progress& progress) {
  // A model that cannot be read is told before seconds are spent.
  if (options.model) {
    const auto readable = parse_full_model(*options.model, recorded.front().channels[channel].rate);
    if (!readable) return tl::unexpected(readable.error());
  }
  WitnessNames witnesses;
  if (!options.witnesses.empty()) witnesses = options.witnesses;
  const auto look = prepare_channel(recorded, channel, witnesses, progress.part(0.0, 0.1));
  if (!look) return tl::unexpected(look.error());
  return diagnose_channel(*look, options, progress.part(0.1, 1.0));
}

Result<v1::DiagnosisReport> diagnose_channel(const RecordedChannel& look,
                                             const DiagnoseOptions& options,
                                             const Progress& progress) {
  const PreparedChannel& prepared = look.prepared;
  const std::shared_ptr<const Subject>& subject = prepared.subject;
  const Result<std::string> named =
      options.model ? *options.model : model_for(look, progress.part(0.0, 0.15));
  if (!named) return tl::unexpected(named.error());
  const Result<FullModel> start = started(*named, prepared, progress.part(0.15, 0.2));
  if (!start) return tl::unexpected(start.error());

  v1::DiagnosisReport out;
  out.set_channel(prepared.name);
  out.set_unit(std::string(si_symbol(subject->quantity)));
  out.set_rate_hz(subject->rate.value);
  for (const Witness& one : subject->witnesses) out.add_witnesses(one.name);
  if (!subject->still.empty())
    out.add_notes(
        fmt::format("Never changes, so that nothing can follow it: {}.", names_of(subject->still)));
  if (!options.model)
    out.add_notes(fmt::format(
        "No model was named: of {}, its sub-models and what FN, QN and DR add to them, {} is "
        "the simplest of the best held-out likelihood.",
        kDefaultModel, *named));
  for (const std::string& note : prepared.notes) out.add_notes(note);
  if (subject->replicates() == 1)
    out.add_notes(
        "One replicate: its four quarters stand in for replicates, each predicted from the others. "
        "That is weaker proof: record again after a restart to be sure.");

  FittedModel model = fit_with_resonances(subject, *start, progress.part(0.2, 0.25));
  out.set_model(print(model.fit.model));
  out.set_fitted_model(print_with_values(FullModel{model.fit.model.noise, sized_effects(model)}));
  out.set_estimator(likelihood_estimator(moments_estimator(subject->replicates())));
  LeftOver left = left_over(model);
  *out.mutable_before() = budget_of(model, left);
  add_integrity(series_of(look.recorded, look.channel), out);
  *out.mutable_compared_before() = comparison_of(model, left, prepared.name, prepared.replicates);
  const double first = model.fit.log_likelihood;
  Step step{.added = "", .why = "The model as it was given."};
  std::vector<std::optional<Process>> noise_added{std::nullopt};  // one a rung
  ModelsSeen models;
  models.is_new(model.fit.model);
  const bool defective = out.integrity_size() > 0 && !prepared.changed;
  const bool automatic = options.automatic && !defective;
  if (options.automatic && defective)
    out.add_notes(
        "The samples are defective and could not be mended: the ladder ends after its first term, "
        "because further terms would describe the defect.");
  const int most = automatic ? kMostRungs : 1;
  const auto within = [&](int rung) {
    return progress.part(0.25 + 0.7 * rung / most, 0.25 + 0.7 * (rung + 1) / most);
  };
  const auto add_rung = [&](const MisfitReport& misfit, const std::optional<HeldOut>& heldout) {
    *out.add_ladder() = rung_of({model, left, misfit, heldout}, step, first, prepared.replicates);
  };
  Diagnosis diagnosis = diagnose(model, options.level, within(0));
  if (progress.stopped()) return fail("stopped");
  add_rung(diagnosis.misfit, diagnosis.heldout);
  // The verdict is about the model that was asked for; what follows only climbs.
  add_diagnosis(diagnosis, *subject, out);
  add_misfits(diagnosis.misfit, out);
  put_defects_first(prepared.changed, out);
  add_timing(look.recorded, out);
  forecast_rungs(prepared, options.forecasts, progress, out);
  if (progress.stopped()) return fail("stopped");
  Climb climb(diagnosis, model, options.level);
  NextTerm next;
  next.verdict = diagnosis.verdict;
  if (diagnosis.worth_adding) next.best = std::move(diagnosis.effects.front());
  std::optional<DiagnosisVerdict> remaining;
  for (int rung = 1; rung <= most; ++rung) {
    if (!next.best) {
      remaining = next.verdict;
      break;
    }
    Step taken = step_of(next.best->tried);
    noise_added.push_back(noise_of(next.best->tried));
    FittedModel grown = std::move(next.best->tried.fitted);
    if (automatic) drop_useless(grown, taken, options.level, start->noise);
    if (!models.is_new(grown.fit.model)) {
      out.add_notes(came_back(taken));
      remaining = DiagnosisVerdict::kUnknown;
      break;
    }
    step = std::move(taken);
    model = std::move(grown);
    left = left_over(model);
    const std::optional<HeldOut> heldout =
        step.dropped.empty() ? std::move(next.best->heldout) : held_out(model);
    if (rung == most) {
      add_rung(misfit_of(model), heldout);
      break;
    }
    next = climb.next(model, heldout, within(rung));
    if (progress.stopped()) return fail("stopped");
    add_rung(next.misfit, next.heldout);
  }
  if (automatic && out.ladder_size() > 1) {
    add_findings(model, noise_added, out);
    add_remaining(remaining, out);
  }
  tell_unexplained(out, remaining ? std::optional(out.ladder_size() - 1) : std::nullopt);
  *out.mutable_after() = budget_of(model, left);
  if (out.ladder_size() > 1)
    *out.mutable_compared_after() = comparison_of(model, left, prepared.name, prepared.replicates);
  return out;
}

}  // namespace imunoise::study
