#pragma once

#include "core/array/latents.h"
#include "core/support/result.h"
#include "imunoise/v1/array.pb.h"
#include "study/export/whole/state_space.h"

namespace imunoise::study {

/// The fitted model that a report of `imunoise array` states. Error: a model that cannot be read,
/// or a parameter that it does not have.
Result<ArrayModel> array_model(const v1::ArrayReport& report);

/// The array, and its virtual sensor where the report has one. Errors: as array_model() and
/// state_space().
Result<std::vector<StateSpace>> array_systems(const v1::ArrayReport& report);

}  // namespace imunoise::study
