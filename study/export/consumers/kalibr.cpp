#include <fmt/format.h>

#include "study/export/consumers/densities.h"

namespace imunoise::study::consumers {
namespace {

std::vector<Field> kalibr_fields(const ImuNoise& imu, double) {
  return densities(imu, {"gyroscope_noise_density", "gyroscope_random_walk",
                         "accelerometer_noise_density", "accelerometer_random_walk"});
}

std::string kalibr_file(const Sheet& sheet) {
  return yaml(sheet) + "rostopic: /imu0  # the topic of your bag\n" +
         fmt::format("update_rate: {:g}  # Hz\n", rate_of(sheet.imu));
}

}  // namespace

const Consumer& kalibr() {
  static const Consumer kConsumer{
      .name = "kalibr",
      .title = "Kalibr",
      .file = "imu.yaml",
      .holds = "white noise and random walk, one value for all axes",
      .takes_zero = false,
      .fields = kalibr_fields,
      .write = kalibr_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
