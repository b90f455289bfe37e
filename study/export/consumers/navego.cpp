#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "study/export/consumer.h"

namespace imunoise::study::consumers {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;  // in a radian
constexpr double kMilligrams = 1e3 / 9.80665;          // mg in m/s²

// NaveGo's filter drives the bias by dyn/√corr, which is q = σ·√(2/τ) for dyn = σ·√2.
double dynamic_bias(const AxisNoise& axis) { return markov_bias(axis).sigma * std::sqrt(2.0); }
double correlation(const AxisNoise& axis) { return markov_bias(axis).tc; }

void navego_sensor(const SensorNoise& sensor, char letter, std::string_view walk_name, double angle,
                   double bias, std::string_view unit, std::string_view bias_unit,
                   std::vector<Field>& to) {
  add_field(
      to, std::string(walk_name), sensor,
      [=](const AxisNoise& axis) { return axis.n.value * 60.0 * angle; },
      fmt::format("{}/√h", unit), "N");
  const std::string rate_walk = fmt::format("{}rrw", walk_name.substr(0, 1));
  add_field(
      to, rate_walk, sensor, [=](const AxisNoise& axis) { return axis.k.value * 60.0 * angle; },
      fmt::format("{}/√h/s", unit), "K");
  add_field(
      to, fmt::format("{}b_dyn", letter), sensor,
      [=](const AxisNoise& axis) { return dynamic_bias(axis) * bias; }, std::string(bias_unit),
      "σ·√2, or K·√τ");
  add_field(to, fmt::format("{}b_corr", letter), sensor, correlation, "s",
            "τ; 1e6 s stands for a random walk");
}

std::vector<Field> navego_fields(const ImuNoise& imu, double) {
  std::vector<Field> out;
  navego_sensor(imu.gyro, 'g', "arw", kDegrees, kDegrees, "°", "°/s", out);
  navego_sensor(imu.accelerometer, 'a', "vrw", 1.0, kMilligrams, "m/s", "mg", out);
  return out;
}

std::string navego_file(const Sheet& sheet) {
  std::string out = commented(sheet, "%");
  for (const Field& one : sheet.fields)
    out +=
        fmt::format("imu.{} = {};  % {}\n", one.key, value_list(one, "[", " "), field_words(one));
  return out + "imu_si = imu_si_errors(imu, " + fmt::format("{:.9g}", 1.0 / rate_of(sheet.imu)) +
         ");\n";
}

}  // namespace

const Consumer& navego() {
  static const Consumer kConsumer{
      .name = "navego",
      .title = "NaveGo",
      .file = "imu_noise.m",
      .holds = "white noise and one Markov process or random walk, a value for each axis",
      .axes = AxisRule::kEach,
      .takes_markov = true,
      .remark =
          "gb_dyn and ab_dyn suit NaveGo's filter; its simulator (noise_dbias.m) takes σ "
          "itself, √2 smaller, and adds arrw and vrrw: set these to 0 there. Static biases "
          "(gb_sta, ab_sta) are those of power-on, not noise: set them.",
      .fields = navego_fields,
      .write = navego_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
