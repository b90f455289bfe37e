#pragma once

#include <vector>

#include "core/diagnosis/diagnose.h"
#include "imunoise/v1/diagnosis.pb.h"

namespace imunoise::study {

/// The numbers of a tried term with their intervals (95 %), in SI units.
std::vector<v1::EffectParameter> effect_parameters(const TriedTerm& tried, const Subject& subject);

/// The coefficients of a noise term of a fitted model, by its number, with their intervals (95 %),
/// in SI units: its amplitude first.
std::vector<ReportedNumber> noise_coefficients(const FittedModel& model, std::size_t term);

/// A number as a message.
v1::EffectParameter message_of(const ReportedNumber& from);

/// What was fitted of an effect of a model, by its number: coefficients, amplitudes, heights, with
/// their intervals (95 %), in SI units.
std::vector<v1::EffectParameter> fitted_parameters(const FittedModel& model, std::size_t number);

}  // namespace imunoise::study
