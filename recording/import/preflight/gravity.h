#pragma once

// At rest an accelerometer of three axes shows gravity: that tells its unit.

#include <string>
#include <vector>

#include "recording/import/table/table.h"

namespace imunoise::recording {

/// Gives accelerations that state no unit g or m/s^2 where their norm is within 20 % of gravity,
/// and returns what it recognised. Adds a finding where stated units disagree with gravity, and
/// where angular rates state no unit, or are too large for a sensor at rest. Three axes of one
/// sensor are needed for a norm. Of angular rates it tells about the first `wanted` columns alone.
std::vector<std::string> judge_acceleration(const std::vector<Column>& columns,
                                            std::vector<Unit>& units, std::size_t wanted,
                                            std::vector<Finding>& findings);

/// Makes rates of increments: of columns named so (delta_angle_x, dvel_z) that are in no unit, rad,
/// deg or m/s, and of accelerations in no unit or m/s^2 whose norm is gravity once it is divided by
/// the period, with the rates beside them (Δθ in rad where they state no unit). To be called before
/// units are resolved. Returns what it recognised.
std::vector<std::string> rates_of_increments(std::vector<Column>& columns, Hertz rate);

}  // namespace imunoise::recording
