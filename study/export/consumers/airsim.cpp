#include <fmt/format.h>

#include <cmath>

#include "study/export/consumer.h"

namespace imunoise::study::consumers {
namespace {

// AirSim's bias steps by stability/√τ·√dt: a random walk with K = stability/√τ, whatever its name.
constexpr double kTau = 500.0;  // s

std::vector<Field> airsim_fields(const ImuNoise& imu, double) {
  const double to_deg_sqrt_h =
      coefficient_units(Coefficient::kRandomWalk, Quantity::kAngularRate).to_datasheet;
  const double to_deg_h =
      coefficient_units(Coefficient::kAmplitude, Quantity::kAngularRate).to_datasheet;
  const double to_ug =
      coefficient_units(Coefficient::kAmplitude, Quantity::kAcceleration).to_datasheet;
  const auto tau = [](const AxisNoise&) { return kTau; };
  std::vector<Field> out;
  add_field(
      out, "AngularRandomWalk", imu.gyro,
      [=](const AxisNoise& axis) { return axis.n.value * to_deg_sqrt_h; }, "°/√h", "N");
  add_field(out, "GyroBiasStabilityTau", imu.gyro, tau, "s", "τ, free");
  add_field(
      out, "GyroBiasStability", imu.gyro,
      [=](const AxisNoise& axis) { return axis.k.value * std::sqrt(kTau) * to_deg_h; }, "°/h",
      "K·√τ");
  add_field(
      out, "VelocityRandomWalk", imu.accelerometer,
      [=](const AxisNoise& axis) { return axis.n.value * to_ug * 1e-3; }, "mg/√Hz", "N");
  add_field(out, "AccelBiasStabilityTau", imu.accelerometer, tau, "s", "τ, free");
  add_field(
      out, "AccelBiasStability", imu.accelerometer,
      [=](const AxisNoise& axis) { return axis.k.value * std::sqrt(kTau) * to_ug; }, "µg", "K·√τ");
  return out;
}

std::string airsim_file(const Sheet& sheet) {
  std::string out = "{\n" + json_comment(sheet, "  ") + "  \"SensorType\": 2,\n  \"Enabled\": true";
  for (const Field& one : sheet.fields)
    out += fmt::format(",\n  \"{}\": {}", one.key, value_list(one));
  return out + "\n}\n";
}

}  // namespace

const Consumer& airsim() {
  static const Consumer kConsumer{
      .name = "airsim",
      .title = "AirSim",
      .file = "settings.json",
      .holds = "white noise and random walk, one value for all axes",
      .remark = "Copy the object to Vehicles/NAME/Sensors/Imu of your settings.json.",
      .fields = airsim_fields,
      .write = airsim_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
