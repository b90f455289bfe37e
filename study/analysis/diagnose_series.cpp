#include "study/analysis/diagnose_series.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/diagnosis/diagnose.h"
#include "core/spectrum/cross_power.h"
#include "study/analysis/diagnosis_report.h"
#include "study/analysis/prepare.h"
#include "study/analysis/select_model.h"
#include "study/analysis/series.h"

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
    out.push_back({series.channel, series.replicates});
  }
  return out;
}

// The noise's starting values: moments of the recording as it is.
Result<Model> started(const Model& noise, const Series& series, const Progress& progress) {
  auto measured = measure(series, {}, progress);
  if (!measured) return tl::unexpected(measured.error());
  if (auto enough = enough_scales(noise, *measured); !enough) return tl::unexpected(enough.error());
  return mugmwm(noise, *measured, Weighting::kFull, progress).model;
}

// The simplest model that predicts replicates as well as the best does.
Result<Chosen> chosen_model(const Series& series, const Progress& progress) {
  const Result<v1::ChoiceReport> choice = select_model(series, {}, progress);
  if (!choice) return tl::unexpected(choice.error());
  const v1::CandidateModel* simplest = &choice->candidates(0);
  for (const v1::CandidateModel& one : choice->candidates()) {
    if (one.verdict() == v1::equivalent && one.parameters() < simplest->parameters())
      simplest = &one;
  }
  const Result<FullModel> model =
      parse_full_model(simplest->model(), series.replicates.front().rate());
  if (!model) return tl::unexpected(model.error());
  return Chosen{*model, fmt::format("No model was named: {} was chosen by cross-validation among "
                                    "the sub-models of {}.",
                                    simplest->model(), kDefaultModel)};
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

}  // namespace

Result<v1::DiagnosisReport> diagnose_series(const std::vector<recording::Replicate>& recordings,
                                            std::size_t channel, const DiagnoseOptions& options,
                                            const Progress& progress) {
  const Series series = series_of(recordings, channel);
  for (std::size_t k = 0; k < series.replicates.size(); ++k) {
    if (series.replicates[k].size() < kFewestSamples)
      return fail(
          fmt::format("{}: {} samples are too few", series.names[k], series.replicates[k].size()));
  }
  const auto channels = witnesses_of(recordings, channel, options.witnesses);
  if (!channels) return tl::unexpected(channels.error());
  const Result<Chosen> start = current_model(series, options, progress.part(0.0, 0.2));
  if (!start) return tl::unexpected(start.error());
  auto subject = std::make_shared<const Subject>(
      make_subject(series.replicates, *channels, progress.part(0.2, 0.3)));
  for (const EffectTerm& term : start->model.effects) {
    if (auto fits = check(term, *subject); !fits) return tl::unexpected(fits.error());
  }

  v1::DiagnosisReport out;
  out.set_channel(series.channel);
  out.set_unit(std::string(si_symbol(subject->quantity)));
  out.set_rate_hz(subject->rate.value);
  out.set_seed(options.seed);
  for (const Witness& one : subject->witnesses) out.add_witnesses(one.name);
  if (!start->note.empty()) out.add_notes(start->note);
  if (subject->replicates() == 1)
    out.add_notes(
        "One replicate: nothing can be held out, so that no effect is proven on data it "
        "was not fitted to.");

  Trial model = fit_full_model(subject, start->model, progress.part(0.3, 0.35));
  out.set_model(print(model.fit.model));
  out.set_fitted_model(print_with_values(model.fit.model));
  *out.mutable_before() = budget_of(model);
  const double first = model.fit.log_likelihood;
  std::string added;
  std::string why = "The model as it was given.";
  const int most = options.automatic ? kMostRungs : 1;
  for (int rung = 0; rung < most; ++rung) {
    const double begin = 0.35 + 0.6 * rung / most;
    Diagnosis diagnosis =
        diagnose(model, {options.level}, progress.part(begin, begin + 0.6 / most));
    if (progress.stopped()) return fail("stopped");
    *out.add_ladder() = rung_of(model, added, first, diagnosis.misfit_p, diagnosis.heldout, why);
    // The verdict is about the model that was asked for; later rounds only climb.
    if (rung == 0) add_diagnosis(diagnosis, *subject, series.names, out);
    if (!diagnosis.worth_adding) break;
    RankedEffect& best = diagnosis.effects.front();
    added = added_term(best.tried);
    why = fmt::format("{} explains {:.1f} nats ({:.1f} more than chance).", best.tried.effect,
                      best.tried.likelihood_gain, best.tried.gain);
    model = std::move(best.tried.trial);
    if (rung + 1 < most) continue;
    const Current after = current_of(model.regression, model.fit);
    *out.add_ladder() =
        rung_of(model, added, first, misfit_p_value(misfit_of(after)), best.heldout, why);
  }
  *out.mutable_after() = budget_of(model);
  return out;
}

}  // namespace imunoise::study
