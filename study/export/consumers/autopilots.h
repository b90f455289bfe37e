#pragma once

#include "study/export/consumer.h"

namespace imunoise::study {

/// What a sensor at rest says of one in flight.
inline constexpr std::string_view kNoVibration =
    "Measured at rest, without vibration: most values are far smaller than the autopilot's "
    "defaults, which include motors, and some lie below what it takes. Raise them until the "
    "filter's innovations are consistent in flight.";

/// The names of an autopilot's parameters.
struct AutopilotKeys {
  std::string_view gyro_noise;
  std::string_view gyro_bias;
  std::string_view accelerometer_noise;
  std::string_view accelerometer_bias;
};

/// Standard deviations of a filter that holds its input over steps of `step` seconds, and
/// integrates them: N/√T and K/√T.
std::vector<Field> autopilot_fields(const ImuNoise& imu, double step, const AutopilotKeys& keys);

}  // namespace imunoise::study
