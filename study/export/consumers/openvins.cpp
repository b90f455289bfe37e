#include <fmt/format.h>

#include "study/export/consumers/densities.h"

namespace imunoise::study::consumers {
namespace {

std::vector<Field> openvins_fields(const ImuNoise& imu, double) {
  return densities(imu, {"gyroscope_noise_density", "gyroscope_random_walk",
                         "accelerometer_noise_density", "accelerometer_random_walk"});
}

std::string openvins_file(const Sheet& sheet) {
  return "%YAML:1.0\n" + yaml_under("imu0", sheet) +
         "  rostopic: /imu0  # the topic of your bag\n" +
         fmt::format("  update_rate: {:g}  # Hz\n", rate_of(sheet.imu));
}

}  // namespace

const Consumer& openvins() {
  static const Consumer kConsumer{
      .name = "openvins",
      .title = "OpenVINS",
      .file = "kalibr_imu_chain.yaml",
      .holds = "white noise and random walk, one value for all axes",
      .takes_zero = false,
      .fields = openvins_fields,
      .write = openvins_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
