#pragma once

// How well a model does, once it is fitted: a rung of the ladder.

#include <string>

#include "core/effect/full_model.h"
#include "study/analysis/diagnosis_report.h"
#include "study/analysis/prepared_channel.h"

namespace imunoise::study {

/// The model with starting values for its noise: those that fit the moments of the channel as it
/// is. Error: a model that cannot be read, more parameters than scales, an effect that the channel
/// cannot show or whose witness it lacks.
Result<FullModel> started(const std::string& model, const PreparedChannel& prepared,
                          const Progress& progress = {});

/// Fits a model and judges it, with what its figures are drawn from. Error: as started(), or the
/// caller stopped it.
Result<v1::Rung> evaluate(const std::string& model, const PreparedChannel& prepared,
                          const Step& step, const Progress& progress = {});

}  // namespace imunoise::study
