#pragma once

// At rest an accelerometer of three axes shows gravity: that tells its unit.

#include <string>
#include <vector>

#include "recording/import/table/table.h"

namespace imunoise::recording {

/// Gives accelerations that state no unit g or m/s^2 where their norm is within 20 % of gravity,
/// and returns what it recognised. Adds a finding where stated units disagree with gravity, and
/// where angular rates state no unit. Three axes of one sensor are needed for a norm.
std::vector<std::string> judge_acceleration(const std::vector<Column>& columns,
                                            std::vector<Unit>& units,
                                            std::vector<Finding>& findings);

}  // namespace imunoise::recording
