#pragma once

// What the user wants of the sensor, as its registers hold it.

#include <cstdint>

#include "core/support/result.h"
#include "core/support/units.h"
#include "drivers/adis16405/codec/registers.h"

namespace imunoise::drivers::adis16405 {

struct Settings {
  std::uint16_t sensitivity_averaging = kDefaultSensitivityAveraging;
  std::uint16_t sample_period = kDefaultSamplePeriod;
  bool self_test = true;
};

/// SENS_AVG of a full scale of the gyroscopes and a filter of two stages of 2^filter taps each.
/// Preconditions: 300, 150 or 75 °/s; 0 to 7. Error: the range needs a stronger filter.
Result<std::uint16_t> sensitivity_averaging(unsigned range, unsigned filter);

/// SMPL_PRD of the nearest rate, at most 1 % off. Error: there is none; names the nearest.
Result<std::uint16_t> sample_period(Hertz rate);

}  // namespace imunoise::drivers::adis16405
