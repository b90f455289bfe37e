#include "study/export/consumers/densities.h"

namespace imunoise::study::consumers {
namespace {

// LIO-SAM squares all four for GTSAM, and scales the biases by the square root of time.
std::vector<Field> lio_sam_fields(const ImuNoise& imu, double) {
  return densities(imu, {"imuGyrNoise", "imuGyrBiasN", "imuAccNoise", "imuAccBiasN"});
}

std::string lio_sam_file(const Sheet& sheet) { return yaml_under("lio_sam", sheet); }

}  // namespace

const Consumer& lio_sam() {
  static const Consumer kConsumer{
      .name = "lio-sam",
      .title = "LIO-SAM",
      .file = "params.yaml",
      .holds = "white noise and random walk, one value for all axes",
      .fields = lio_sam_fields,
      .write = lio_sam_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
