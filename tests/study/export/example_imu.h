#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/export/export.h"

namespace imunoise::testing {

/// Three gyro axes and three accelerometer axes of one model each, without intervals. Models are
/// in the grammar with their values.
inline study::ImuNoise example_imu(const std::string& gyro, const std::string& accelerometer,
                                   Hertz rate) {
  study::ImuNoise out;
  for (const char axis : {'x', 'y', 'z'}) {
    out.gyro.axes.push_back(study::axis_noise(std::string("gyro_") + axis, Quantity::kAngularRate,
                                              rate, parse_model(gyro, rate).value()));
    out.accelerometer.axes.push_back(study::axis_noise(std::string("acc_") + axis,
                                                       Quantity::kAcceleration, rate,
                                                       parse_model(accelerometer, rate).value()));
  }
  return out;
}

/// The numbers behind `key` in a file: of the first line that has it and is not a comment, up to
/// the comment at its end. Empty: there are none.
std::vector<double> numbers_of(const std::string& file, const std::string& key);

}  // namespace imunoise::testing
