#include "study/export/consumers/densities.h"

namespace imunoise::study {

std::vector<Field> densities(const ImuNoise& imu, const DensityKeys& keys) {
  std::vector<Field> out;
  add_field(out, std::string(keys.accelerometer_n), imu.accelerometer, density, "m/s²/√Hz", "N");
  add_field(out, std::string(keys.accelerometer_k), imu.accelerometer, walk, "m/s³/√Hz", "K");
  add_field(out, std::string(keys.gyro_n), imu.gyro, density, "rad/s/√Hz", "N");
  add_field(out, std::string(keys.gyro_k), imu.gyro, walk, "rad/s²/√Hz", "K");
  return out;
}

}  // namespace imunoise::study
