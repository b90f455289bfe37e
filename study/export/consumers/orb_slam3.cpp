#include <fmt/format.h>

#include "study/export/consumers/densities.h"

namespace imunoise::study::consumers {
namespace {

// ORB-SLAM3 itself multiplies densities by √f, and divides walks by it.
std::vector<Field> orb_slam3_fields(const ImuNoise& imu, double) {
  return densities(imu, {"IMU.NoiseGyro", "IMU.GyroWalk", "IMU.NoiseAcc", "IMU.AccWalk"});
}

std::string orb_slam3_file(const Sheet& sheet) {
  return yaml(sheet) + fmt::format("IMU.Frequency: {:.1f}  # Hz\n", rate_of(sheet.imu));
}

}  // namespace

const Consumer& orb_slam3() {
  static const Consumer kConsumer{
      .name = "orb-slam3",
      .title = "ORB-SLAM3",
      .file = "settings.yaml",
      .holds = "white noise and random walk, one value for all axes",
      .fields = orb_slam3_fields,
      .write = orb_slam3_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
