#pragma once

#include <vector>

#include "core/diagnosis/diagnose.h"
#include "imunoise/v1/diagnosis.pb.h"

namespace imunoise::study {

/// The numbers of a tried effect with their intervals (95 %), in SI units.
std::vector<v1::EffectParameter> effect_parameters(const TriedEffect& effect,
                                                   const Subject& subject);

/// What was fitted of an effect of a model, by its number: coefficients, amplitudes, heights, with
/// their intervals (95 %), in SI units.
std::vector<v1::EffectParameter> fitted_parameters(const Trial& trial, std::size_t number);

/// The unit of a coupling of one quantity to another: "rad/s/K"; "1" where both are the same.
std::string coupling_unit(Quantity subject, const Witness& witness, const EffectTerm& term);

}  // namespace imunoise::study
