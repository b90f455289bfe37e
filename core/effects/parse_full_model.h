#pragma once

#include <string_view>

#include "core/effect/full_model.h"

namespace imunoise {

/// Reads `WN + RW + line(f=0.51) + witness(temperature, lag=300)`: terms of parse_model() and
/// effects in any order. DR is the effect ramp(own). Error: as parse_model(), or what is wrong with
/// an effect.
Result<FullModel> parse_full_model(std::string_view text, Hertz rate);

}  // namespace imunoise
