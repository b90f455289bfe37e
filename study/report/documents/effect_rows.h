#pragma once

#include <google/protobuf/repeated_ptr_field.h>

#include <string>
#include <vector>

#include "imunoise/v1/noise.pb.h"
#include "study/words/number.h"

namespace imunoise::report {

/// What a fit found of one number of an effect, with its interval and unit.
std::string value_of(const v1::EffectParameter& one, Digits digits);

/// The effects of a model for a table of three columns (term, number, value); of the numbers that
/// each replicate has, the first few.
std::vector<std::vector<std::string>> effect_rows(
    const google::protobuf::RepeatedPtrField<v1::FittedEffect>& effects, Digits digits);

}  // namespace imunoise::report
