#pragma once

// What the channels of a file were taken for, in words.

#include <span>
#include <string>
#include <vector>

#include "core/support/units.h"
#include "recording/import/table/options.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

/// Channels of one quantity and unit together: "angular rates wx, wy, wz: deg/s (stated)". Without
/// accelerations whose unit gravity told.
std::vector<std::string> channels_in_words(std::span<const Column> columns,
                                           std::span<const Unit> units,
                                           const std::vector<UnitRule>& rules);

}  // namespace imunoise::recording
