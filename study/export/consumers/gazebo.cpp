#include <fmt/format.h>

#include <cmath>

#include "study/export/consumer.h"

namespace imunoise::study::consumers {
namespace {

// The bias of Gazebo's GaussianNoiseModel has the stationary variance s²·τ/2 where s is
// dynamic_bias_stddev and τ its correlation time: s = σ·√(2/τ), and K where τ is endless.
void gazebo_sensor(const SensorNoise& sensor, std::string_view group, std::string_view unit,
                   std::vector<Field>& to) {
  const std::string path = fmt::format("imu/{}/", group);
  add_field(
      to, path + "stddev", sensor,
      [](const AxisNoise& axis) { return axis.n.value * std::sqrt(axis.rate.value); },
      std::string(unit), "N·√f, " + rate_words(sensor));
  add_field(
      to, path + "dynamic_bias_stddev", sensor,
      [](const AxisNoise& axis) {
        const Markov bias = markov_bias(axis);
        return bias.sigma * std::sqrt(2.0 / bias.tc);
      },
      fmt::format("{}/√s", unit), "K, or σ·√(2/τ) of a Markov process");
  add_field(
      to, path + "dynamic_bias_correlation_time", sensor,
      [](const AxisNoise& axis) { return markov_bias(axis).tc; }, "s",
      "τ; 1e6 s stands for a random walk");
}

std::vector<Field> gazebo_fields(const ImuNoise& imu, double) {
  std::vector<Field> out;
  gazebo_sensor(imu.gyro, "angular_velocity", "rad/s", out);
  gazebo_sensor(imu.accelerometer, "linear_acceleration", "m/s²", out);
  return out;
}

std::string gazebo_file(const Sheet& sheet) {
  constexpr std::string_view kAxes = "xyz";
  std::string comment;
  for (const std::string& line : sheet.heading) comment += "  " + line + "\n";
  for (std::size_t at = comment.find("--"); at != std::string::npos; at = comment.find("--"))
    comment.erase(at, 1);  // XML ends comments there
  std::string out = "<!--\n" + comment + "-->\n<imu>\n";
  // Three fields a sensor, in the order of gazebo_sensor().
  for (std::size_t at = 0; at + 2 < sheet.fields.size(); at += 3) {
    const std::string& key = sheet.fields[at].key;
    const std::string group = key.substr(4, key.rfind('/') - 4);
    out += fmt::format("  <{}>\n", group);
    for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
      out += fmt::format(
          "    <{0}><noise type=\"gaussian\"><mean>0</mean><stddev>{1:.7g}</stddev>"
          "<dynamic_bias_stddev>{2:.7g}</dynamic_bias_stddev>"
          "<dynamic_bias_correlation_time>{3:.7g}</dynamic_bias_correlation_time></noise></{0}>\n",
          kAxes[axis], sheet.fields[at].values[axis].value, sheet.fields[at + 1].values[axis].value,
          sheet.fields[at + 2].values[axis].value);
    }
    out += fmt::format("  </{}>\n", group);
  }
  return out + "</imu>\n";
}

}  // namespace

const Consumer& gazebo() {
  static const Consumer kConsumer{
      .name = "gazebo",
      .title = "Gazebo (SDF)",
      .file = "model.sdf",
      .holds = "white noise and one Markov process or random walk, a value for each axis",
      .axes = AxisRule::kEach,
      .takes_markov = true,
      .remark =
          "stddev is that of a sample, not a density; values hold for this update_rate alone.",
      .fields = gazebo_fields,
      .write = gazebo_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
