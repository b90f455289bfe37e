#pragma once

// Operations on noise go on with what a model's effects leave of the samples.

#include <string>
#include <vector>

#include "core/regression/fitted_model.h"
#include "core/wavelet/wavelet_variance.h"
#include "imunoise/v1/noise.pb.h"
#include "study/analysis/series.h"

namespace imunoise::study {

/// A series without what effects add to it.
struct LessEffects {
  Series series;                          ///< borrows `samples`; the same one without effects
  Model noise;                            ///< of the model, as the user wrote it
  std::vector<EffectTerm> effects;        ///< of the model, with the sizes that were fitted
  std::vector<v1::FittedEffect> numbers;  ///< of the effects, with intervals and units
  std::vector<SharedVector> samples{};    ///< a replicate each
  bool sizes_given = false;               ///< by the user: they were estimated all the same
};

/// Fits a model's effects together with its noise (joint_fit()) and takes them out; the first
/// quick_length() samples of each replicate remain. A model without effects leaves the series as it
/// is. Error: more free parameters than scales, replicates too short or without noise, an effect
/// that the series cannot show or whose witness was not recorded with it, or the caller stopped it.
Result<LessEffects> take_out_effects(const Series& series, const FullModel& model,
                                     const Progress& progress = {});

/// A model to begin a joint fit with: with values for its noise that fit the moments `measured`.
/// Error: more free parameters than scales, or an effect that the subject cannot
/// show.
Result<FullModel> start_of(FullModel model, const Subject& subject,
                           const std::vector<WaveletVariance>& measured,
                           const Progress& progress = {});

/// The channels that the effects of models follow, each once. Error: one that cannot be read.
Result<std::vector<std::string>> witnesses_of(const std::vector<std::string>& models);

/// The effects of a fitted model with their numbers.
std::vector<v1::FittedEffect> fitted_effects(const FittedModel& fitted);
/// The same with their sizes, as a simulation takes them.
std::vector<EffectTerm> sized_effects(const FittedModel& fitted);

/// A model in the grammar, its effects without their sizes.
std::string model_text(const Model& noise, std::vector<EffectTerm> effects);

/// What was taken out of the samples, for people.
std::string taken_out_note(const LessEffects& left);

/// Says of a report's model that `noise` was fitted beside the effects that were taken out: sets
/// its model, fitted model, effects and a note about them.
template <class Report>
void add_effects(const LessEffects& left, const Model& noise, Report& to) {
  to.set_model(model_text(noise, left.effects));
  to.set_fitted_model(print_with_values(FullModel{noise, left.effects}));
  for (const v1::FittedEffect& one : left.numbers) *to.add_effects() = one;
  if (!left.effects.empty()) to.add_notes(taken_out_note(left));
}

}  // namespace imunoise::study
