#include "study/analysis/less_effects.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/effect/columns.h"
#include "core/effects/parse_full_model.h"
#include "core/estimate/estimators.h"
#include "core/spectrum/cross_power.h"
#include "core/support/counted.h"
#include "core/support/parallel.h"
#include "study/analysis/effect_parameters.h"
#include "study/analysis/prepare.h"

namespace imunoise::study {
namespace {

Result<std::vector<NamedChannel>> followed(const FullModel& model, const Series& series) {
  std::vector<NamedChannel> out;
  for (const std::string& name : witnesses_of(model)) {
    const auto found = std::find_if(series.beside.begin(), series.beside.end(),
                                    [&](const NamedChannel& one) { return one.name == name; });
    if (found == series.beside.end()) {
      std::string known;
      for (const NamedChannel& one : series.beside) known += (known.empty() ? "" : ", ") + one.name;
      return fail(
          fmt::format("model: an effect follows '{}', which was not recorded beside {} ({})", name,
                      series.channel, known.empty() ? "nothing was" : "there are: " + known));
    }
    out.push_back(*found);
  }
  return out;
}

Result<void> long_enough(const Series& series) {
  for (std::size_t k = 0; k < series.replicates.size(); ++k) {
    if (series.replicates[k].size() >= kFewestSamples) continue;
    return fail(fmt::format("{}: too short to fit effects to, {}; record at least {}",
                            series.names[k], counted(series.replicates[k].size(), "sample"),
                            kFewestSamples));
  }
  return {};
}

Signal signal_of(const SharedVector& samples, const Subject& subject) {
  return {std::span<const double>(samples.data(), static_cast<std::size_t>(samples.size())),
          subject.rate, subject.quantity};
}

LessEffects what_is_left(const Series& series, const Model& noise, const FittedModel& trial) {
  const Subject& subject = trial.regression.subject();
  LessEffects out{series, noise, sized_effects(trial), fitted_effects(trial), {}};
  out.samples.resize(subject.replicates());
  for_each_index(subject.replicates(), [&](std::size_t k) {
    out.samples[k] = trial.regression.residual_samples(trial.fit.effects.value, k);
  });
  for (std::size_t k = 0; k < subject.replicates(); ++k)
    out.series.replicates[k] = signal_of(out.samples[k], subject);
  out.series.beside.clear();
  return out;
}

}  // namespace

Result<LessEffects> take_out_effects(const Series& series, const FullModel& written,
                                     const Progress& progress) {
  if (written.effects.empty()) return LessEffects{series, written.noise, {}, {}, {}};
  const FullModel model = as_fitted(written);
  if (auto enough = long_enough(series); !enough) return tl::unexpected(enough.error());
  const auto witnesses = followed(model, series);
  if (!witnesses) return tl::unexpected(witnesses.error());
  const auto measured = measured_replicates(series, {}, progress.part(0.0, 0.2));
  if (!measured) return tl::unexpected(measured.error());
  const auto subject = std::make_shared<const Subject>(
      make_subject(series.replicates, *witnesses, {}, progress.part(0.2, 0.4)));
  if (progress.stopped()) return fail("stopped");
  const auto start = start_of(model, *subject, *measured, progress.part(0.4, 0.6));
  if (!start) return tl::unexpected(start.error());
  const FittedModel trial = fit_full_model(subject, *start, progress.part(0.6, 1.0));
  if (progress.stopped()) return fail("stopped");
  LessEffects out = what_is_left(series, model.noise, trial);
  out.sizes_given = std::any_of(written.effects.begin(), written.effects.end(),
                                [](const EffectTerm& one) { return shape_of(one) != one; });
  return out;
}

Result<FullModel> start_of(FullModel model, const Subject& subject,
                           const std::vector<WaveletVariance>& measured, const Progress& progress) {
  if (auto sound = can_be_fitted(model.noise, measured); !sound)
    return tl::unexpected(sound.error());
  for (const EffectTerm& term : model.effects) {
    if (auto fits = check(term, subject); !fits) return tl::unexpected(fits.error());
  }
  model.noise = mugmwm(model.noise, measured, Weighting::kFull, progress).model;
  return model;
}

Result<std::vector<std::string>> witnesses_of(const std::vector<std::string>& models) {
  FullModel all;
  for (const std::string& text : models) {
    const auto model = parse_full_model(text, kAnyRate);
    if (!model) return tl::unexpected(model.error());
    all.effects.insert(all.effects.end(), model->effects.begin(), model->effects.end());
  }
  return witnesses_of(all);
}

std::vector<v1::FittedEffect> fitted_effects(const FittedModel& fitted) {
  std::vector<v1::FittedEffect> out;
  const std::vector<EffectTerm>& effects = fitted.regression.effects();
  for (std::size_t e = 0; e < effects.size(); ++e) {
    v1::FittedEffect& one = out.emplace_back();
    one.set_term(print(effects[e]));
    for (v1::EffectParameter& number : fitted_parameters(fitted, e))
      *one.add_parameters() = std::move(number);
  }
  return out;
}

std::vector<EffectTerm> sized_effects(const FittedModel& fitted) {
  std::vector<EffectTerm> out = fitted.regression.effects();
  for (std::size_t e = 0; e < out.size(); ++e)
    out[e] = with_truth(out[e], fitted_numbers({fitted, e}));
  return out;
}

std::string model_text(const Model& noise, std::vector<EffectTerm> effects) {
  for (EffectTerm& term : effects) term = shape_of(std::move(term));
  return print(FullModel{noise, std::move(effects)});
}

std::string taken_out_note(const LessEffects& left) {
  std::string terms;
  for (const EffectTerm& one : left.effects)
    terms += (terms.empty() ? "" : ", ") + print(shape_of(one));
  return fmt::format(
      "The effects of the model were fitted together with its noise and taken out of the samples "
      "first: {}.{}",
      terms, left.sizes_given ? " The sizes that you wrote were estimated, not kept." : "");
}

}  // namespace imunoise::study
