#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/export/consumer.h"

namespace imunoise::study::consumers {
namespace {

constexpr double kHour = 3600.0;    // s
constexpr double kMilligal = 1e-5;  // m/s²

// Of all biases; that of an axis without one does not count.
double shared_time(const ImuNoise& imu) {
  double out = kEndless;
  for (const SensorNoise* const sensor : {&imu.gyro, &imu.accelerometer}) {
    for (const AxisNoise& one : sensor->axes) out = std::min(out, markov_bias(one).tc);
  }
  return out;
}

std::function<double(const AxisNoise&)> sigma_times(double factor) {
  return [=](const AxisNoise& axis) { return markov_bias(axis).sigma * factor; };
}

std::vector<Field> kf_gins_fields(const ImuNoise& imu, double) {
  const double deg_sqrt_h =
      coefficient_units(Coefficient::kRandomWalk, Quantity::kAngularRate).to_datasheet;
  const double deg_h =
      coefficient_units(Coefficient::kAmplitude, Quantity::kAngularRate).to_datasheet;
  std::vector<Field> out;
  add_field(
      out, "arw", imu.gyro, [=](const AxisNoise& axis) { return axis.n.value * deg_sqrt_h; },
      "°/√h", "N");
  add_field(
      out, "vrw", imu.accelerometer,
      [](const AxisNoise& axis) { return axis.n.value * std::sqrt(kHour); }, "m/s/√h", "N");
  add_field(out, "gbstd", imu.gyro, sigma_times(deg_h), "°/h", "σ, or K·√(τ/2)");
  add_field(out, "abstd", imu.accelerometer, sigma_times(1.0 / kMilligal), "mGal",
            "σ, or K·√(τ/2)");
  out.push_back(
      {"corrtime", {{shared_time(imu) / kHour}}, "h", "τ; 1e6 s stands for a random walk"});
  return out;
}

std::string kf_gins_file(const Sheet& sheet) { return yaml_under("imunoise", sheet); }

}  // namespace

const Consumer& kf_gins() {
  static const Consumer kConsumer{
      .name = "kf-gins",
      .title = "KF-GINS",
      .file = "kf-gins.yaml",
      .holds =
          "white noise and one Markov process or random walk, a value for each axis, one "
          "correlation time",
      .axes = AxisRule::kEach,
      .takes_markov = true,
      .one_time = true,
      .remark =
          "Scale factors (gsstd, asstd) are not noise at rest: keep yours. The initial bias "
          "uncertainty (initbgstd, initbastd) is that of power-on, not gbstd: set it.",
      .fields = kf_gins_fields,
      .write = kf_gins_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
