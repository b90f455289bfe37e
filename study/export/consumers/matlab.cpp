#include <fmt/format.h>

#include "study/export/consumers/densities.h"

namespace imunoise::study::consumers {
namespace {

std::vector<Field> matlab_fields(const ImuNoise& imu, double) {
  return densities(imu, {"Gyroscope.NoiseDensity", "Gyroscope.RandomWalk",
                         "Accelerometer.NoiseDensity", "Accelerometer.RandomWalk"});
}

std::string matlab_file(const Sheet& sheet) {
  std::string out = commented(sheet, "%");
  out += fmt::format("imu = imuSensor('accel-gyro', 'SampleRate', {:g});\n", rate_of(sheet.imu));
  for (const Field& one : sheet.fields)
    out +=
        fmt::format("imu.{} = {};  % {}\n", one.key, value_list(one, "[", " "), field_words(one));
  if (!sheet.imu.gyro.axes.empty()) out += "imu.Gyroscope.NoiseType = 'single-sided';\n";
  if (!sheet.imu.accelerometer.axes.empty())
    out += "imu.Accelerometer.NoiseType = 'single-sided';\n";
  return out;
}

}  // namespace

const Consumer& matlab() {
  static const Consumer kConsumer{
      .name = "matlab",
      .title = "MATLAB imuSensor",
      .file = "imu_noise.m",
      .holds = "white noise and random walk, a value for each axis",
      .axes = AxisRule::kEach,
      .remark = "NoiseType 'double-sided', MATLAB's default, would divide the densities by √2.",
      .fields = matlab_fields,
      .write = matlab_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
