#include "study/export/consumers/autopilots.h"

#include <fmt/format.h>

#include <cmath>

namespace imunoise::study {

std::vector<Field> autopilot_fields(const ImuNoise& imu, double step, const AutopilotKeys& keys) {
  const auto n = [step](const AxisNoise& axis) { return axis.n.value / std::sqrt(step); };
  const auto k = [step](const AxisNoise& axis) { return axis.k.value / std::sqrt(step); };
  const std::string with = fmt::format("T = {:g} ms", 1e3 * step);
  std::vector<Field> out;
  add_field(out, std::string(keys.accelerometer_noise), imu.accelerometer, n, "m/s²",
            "N/√T, " + with);
  add_field(out, std::string(keys.accelerometer_bias), imu.accelerometer, k, "m/s³",
            "K/√T, " + with);
  add_field(out, std::string(keys.gyro_noise), imu.gyro, n, "rad/s", "N/√T, " + with);
  add_field(out, std::string(keys.gyro_bias), imu.gyro, k, "rad/s²", "K/√T, " + with);
  return out;
}

}  // namespace imunoise::study
