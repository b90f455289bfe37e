#include <fmt/format.h>

#include <cmath>

#include "study/export/consumer.h"

namespace imunoise::study::consumers {
namespace {

// Of imu_corrector: a standard deviation for each axis, where the message has a variance.
std::vector<Field> autoware_fields(const ImuNoise& imu, double) {
  constexpr const char* kAxes[] = {"xx", "yy", "zz"};
  std::vector<Field> out;
  for (std::size_t i = 0; i < imu.gyro.axes.size(); ++i) {
    const SensorNoise one{imu.gyro.quantity, {imu.gyro.axes[i]}};
    add_field(
        out, fmt::format("angular_velocity_stddev_{}", kAxes[i]), one,
        [](const AxisNoise& axis) { return axis.n.value * std::sqrt(axis.rate.value); }, "rad/s",
        "N·√f, " + rate_words(one));
  }
  if (imu.accelerometer.axes.empty()) return out;
  add_field(
      out, "acceleration_stddev", reduced(imu.accelerometer, AxisRule::kWorst),
      [](const AxisNoise& axis) { return axis.n.value * std::sqrt(axis.rate.value); }, "m/s²",
      "N·√f, " + rate_words(imu.accelerometer));
  return out;
}

std::string autoware_file(const Sheet& sheet) {
  std::string out = commented(sheet, "#") + "/**:\n  ros__parameters:\n";
  for (const Field& one : sheet.fields)
    out += fmt::format("    {}: {}  # {}\n", one.key, value_list(one), field_words(one));
  return out;
}

}  // namespace

const Consumer& autoware() {
  static const Consumer kConsumer{
      .name = "autoware",
      .title = "Autoware imu_corrector",
      .file = "imu_corrector.param.yaml",
      .holds = "white noise, a value for each axis of the gyro; no random walk",
      .axes = AxisRule::kEach,
      .takes_walk = false,
      .fields = autoware_fields,
      .write = autoware_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
