#pragma once

#include <optional>
#include <string_view>

#include "drivers/emulator/measurement/sample_source.h"

namespace imunoise::emulator {

/// What a channel of drivers shows: "gyro_x", "acc_y", "mag_z", "temperature"; in SI. Nothing for
/// other names.
std::optional<double> value_of(const Measurement& measurement, std::string_view channel);

/// The same in another unit ("deg/s", "g", "degC"); a unit that is not known counts as SI. 0 for
/// other names.
double value_in_unit(const Measurement& measurement, std::string_view channel,
                     std::string_view unit);

}  // namespace imunoise::emulator
