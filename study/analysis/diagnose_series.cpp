#include "study/analysis/diagnose_series.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/useless.h"
#include "core/spectrum/cross_power.h"
#include "study/analysis/comparison.h"
#include "study/analysis/diagnosis_report.h"
#include "study/analysis/integrity_report.h"
#include "study/analysis/misfit_sentences.h"
#include "study/analysis/prepare.h"
#include "study/analysis/select_model.h"
#include "study/analysis/series.h"
#include "study/analysis/sound_parts.h"

namespace imunoise::study {
namespace {

constexpr int kMostRungs = 8;

struct Chosen {
  FullModel model;  ///< every value of the noise set
  std::string note;
};

Result<std::vector<NamedChannel>> witnesses_of(const std::vector<recording::Replicate>& recordings,
                                               std::size_t channel,
                                               const std::vector<std::string>& wanted) {
  const std::vector<recording::Channel>& known = recordings.front().channels;
  for (const std::string& name : wanted) {
    const bool exists = std::any_of(known.begin(), known.end(), [&](const recording::Channel& one) {
      return one.name == name;
    });
    if (!exists) return fail(fmt::format("witness {}: no such channel", name));
  }
  std::vector<NamedChannel> out;
  for (std::size_t c = 0; c < known.size(); ++c) {
    const bool asked =
        wanted.empty() || std::find(wanted.begin(), wanted.end(), known[c].name) != wanted.end();
    if (c == channel || !asked) continue;
    const Series series = series_of(recordings, c);
    const Unit& unit = known[c].unit;
    out.push_back({series.channel, series.replicates,
                   unit.quantity == Quantity::kUnknown ? unit.symbol : ""});
  }
  return out;
}

// The noise's starting values: moments of the recording as it is.
Result<Model> started(const Model& noise, const Series& series, const Progress& progress) {
  auto measured = measure(series, {}, progress);
  if (!measured) return tl::unexpected(measured.error());
  if (auto sound = check_replicates(series, *measured); !sound)
    return tl::unexpected(sound.error());
  if (auto enough = enough_scales(noise, *measured); !enough) return tl::unexpected(enough.error());
  return mugmwm(noise, *measured, Weighting::kFull, progress).model;
}

// The simplest model that predicts replicates as well as the best does.
Result<Chosen> chosen_model(const Series& series, const Progress& progress) {
  const Result<v1::ChoiceReport> choice = select_model(series, {}, progress);
  if (!choice) return tl::unexpected(choice.error());
  const std::string& named = model_to_use(*choice).model();
  const Result<FullModel> model = parse_full_model(named, series.replicates.front().rate());
  if (!model) return tl::unexpected(model.error());
  return Chosen{*model, fmt::format("No model was named: of the sub-models of {}, {} is the "
                                    "simplest that predicts replicates as well as the best does.",
                                    kDefaultModel, named)};
}

Result<Chosen> current_model(const Series& series, const DiagnoseOptions& options,
                             const Progress& progress) {
  Chosen out;
  if (options.model) {
    Result<FullModel> read = parse_full_model(*options.model, series.replicates.front().rate());
    if (!read) return tl::unexpected(read.error());
    out.model = std::move(*read);
  } else {
    Result<Chosen> chosen = chosen_model(series, progress.part(0.0, 0.7));
    if (!chosen) return tl::unexpected(chosen.error());
    out = std::move(*chosen);
  }
  Result<Model> noise = started(out.model.noise, series, progress.part(0.7, 1.0));
  if (!noise) return tl::unexpected(noise.error());
  out.model.noise = std::move(*noise);
  return out;
}

Step step_of(const TriedEffect& effect) {
  return {.added = printed(effect.suggestion.added),
          .effect = effect.effect,
          .why = fmt::format("{} explains {:.1f} nats; its evidence against chance is {:.1f} nats.",
                             effect.effect, effect.likelihood_gain, effect.gain)};
}

// Takes what the last term made useless out of a model, one after the other.
void drop_useless(Trial& model, Step& step, double level) {
  while (auto useless = useless_term(model, level)) {
    step.dropped.push_back(useless->term);
    step.why += fmt::format(" Beside it {} explains no more than chance ({:.1f} nats).",
                            useless->term, useless->loss);
    model = std::move(useless->without);
  }
}

std::optional<Errors> errors_held_out(const Trial& model) {
  if (!can_hold_out(model)) return std::nullopt;
  return heldout_errors(model);
}

// The rung of a model that somebody wants to know the error of.
v1::Rung judged(const Trial& model, const LeftOver& left, const Step& step,
                const Progress& progress) {
  const std::optional<Errors> heldout = errors_held_out(model);
  progress.report(0.8);
  return rung_of(model, left, step, 0.0, misfit_p_value(misfit_of(model)), heldout);
}

// Works out what the ladder would show were one of the best candidates added, exactly as adding it
// does.
void foretell(const Series& series, const std::shared_ptr<const Subject>& subject, int count,
              const Progress& progress, v1::DiagnosisReport& to) {
  for (v1::EffectCandidate& one : *to.mutable_candidates()) {
    if (count == 0 || progress.stopped()) return;
    if (one.term().empty()) continue;  // a defect of the samples
    --count;
    auto model = parse_full_model(fmt::format("{} + {}", to.model(), one.term()), subject->rate);
    if (!model) continue;
    const Result<Model> noise = started(model->noise, series, {});
    if (!noise) continue;  // the scales are too few for it
    model->noise = *noise;
    const Trial trial = fit_full_model(subject, *model);
    *one.mutable_next() = judged(trial, left_over(trial), {.added = one.term(), .why = ""}, {});
  }
}

std::string names_of(const std::vector<Witness>& witnesses) {
  std::string out;
  for (const Witness& one : witnesses)
    out += fmt::format("{}{}", out.empty() ? "" : ", ", one.name);
  return out;
}

// Of the channels beside the one under study, those that a model names; all, if it names one that
// there is not, so that it can be said which there are.
std::vector<NamedChannel> named_by(const FullModel& model, std::vector<NamedChannel> channels) {
  std::vector<NamedChannel> out;
  for (const EffectTerm& term : model.effects) {
    if (term.witness.empty()) continue;
    const auto is_it = [&](const NamedChannel& one) { return one.name == term.witness; };
    if (std::any_of(out.begin(), out.end(), is_it)) continue;
    const auto found = std::find_if(channels.begin(), channels.end(), is_it);
    if (found == channels.end()) return channels;
    out.push_back(*found);
  }
  return out;
}

}  // namespace

Result<v1::DiagnosisReport> diagnose_series(const std::vector<recording::Replicate>& recorded,
                                            std::size_t channel, const DiagnoseOptions& options,
                                            const Progress& progress) {
  const Series whole = series_of(recorded, channel);
  for (std::size_t k = 0; k < whole.replicates.size(); ++k) {
    if (whole.replicates[k].size() < kFewestSamples)
      return fail(
          fmt::format("{}: {} samples are too few", whole.names[k], whole.replicates[k].size()));
  }
  const SoundParts parts = sound_parts(recorded, channel);
  const std::vector<recording::Replicate>& recordings = parts.replicates;
  const Series series = series_of(recordings, channel);
  auto channels = witnesses_of(recordings, channel, options.witnesses);
  if (!channels) return tl::unexpected(channels.error());
  const Result<Chosen> start = current_model(series, options, progress.part(0.0, 0.2));
  if (!start) return tl::unexpected(start.error());
  // What is not searched needs no witnesses but those of its terms.
  if (!options.search) *channels = named_by(start->model, std::move(*channels));
  auto subject = std::make_shared<const Subject>(
      make_subject(series.replicates, *channels, parts.places, progress.part(0.2, 0.3)));
  if (progress.stopped()) return fail("stopped");  // the subject is then not whole
  for (const EffectTerm& term : start->model.effects) {
    if (auto fits = check(term, *subject); !fits) return tl::unexpected(fits.error());
  }

  v1::DiagnosisReport out;
  out.set_channel(series.channel);
  out.set_unit(std::string(si_symbol(subject->quantity)));
  out.set_rate_hz(subject->rate.value);
  for (const Witness& one : subject->witnesses) out.add_witnesses(one.name);
  if (!subject->still.empty())
    out.add_notes(
        fmt::format("Never changes, so that nothing can follow it: {}.", names_of(subject->still)));
  if (!start->note.empty()) out.add_notes(start->note);
  for (const std::string& note : parts.notes) out.add_notes(note);
  if (subject->replicates() == 1)
    out.add_notes(
        "One replicate: its four quarters stand in for replicates, each predicted from the others. "
        "That is weaker proof: record again after a restart to be sure.");

  Trial model = fit_full_model(subject, start->model, progress.part(0.3, 0.35));
  out.set_model(print(model.fit.model));
  out.set_fitted_model(print_with_values(model.fit.model));
  LeftOver left = left_over(model);
  *out.mutable_before() = budget_of(model, left);
  if (!options.search) {
    *out.mutable_after() = out.before();
    *out.add_ladder() = judged(model, left, {}, progress.part(0.4, 1.0));
    return out;
  }
  add_integrity(whole, out);
  *out.mutable_compared_before() = comparison_of(model, left, series.channel, series.names);
  const double first = model.fit.log_likelihood;
  Step step{.added = "", .why = "The model as it was given."};
  const int most = options.automatic ? kMostRungs : 1;
  for (int rung = 0; rung < most; ++rung) {
    const double begin = 0.35 + 0.6 * rung / most;
    Diagnosis diagnosis =
        diagnose(model, {options.level}, progress.part(begin, begin + 0.6 / most));
    if (progress.stopped()) return fail("stopped");
    *out.add_ladder() = rung_of(model, left, step, first, diagnosis.misfit_p, diagnosis.heldout);
    // The verdict is about the model that was asked for; later rounds only climb.
    if (rung == 0) {
      add_diagnosis(diagnosis, *subject, out);
      add_misfits(diagnosis.misfit, out);
      put_defects_first(parts.changed, out);
      add_timing(recorded, out);
      foretell(series, subject, options.foretold, progress, out);
      if (progress.stopped()) return fail("stopped");
    }
    if (!diagnosis.worth_adding) {
      if (rung > 0) add_remaining(diagnosis.verdict, out);
      break;
    }
    RankedEffect& best = diagnosis.effects.front();
    step = step_of(best.tried);
    model = std::move(best.tried.trial);
    if (options.automatic) drop_useless(model, step, options.level);
    left = left_over(model);
    if (rung + 1 < most) continue;
    if (!step.dropped.empty()) best.heldout = errors_held_out(model);
    *out.add_ladder() =
        rung_of(model, left, step, first, misfit_p_value(misfit_of(model)), best.heldout);
  }
  *out.mutable_after() = budget_of(model, left);
  if (out.ladder_size() > 1)
    *out.mutable_compared_after() = comparison_of(model, left, series.channel, series.names);
  return out;
}

}  // namespace imunoise::study
