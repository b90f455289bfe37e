#include <fmt/format.h>

#include <cmath>

#include "study/export/consumer.h"

namespace imunoise::study::consumers {
namespace {

// A Matrix3 of GTSAM: covariances on the diagonal.
std::vector<Field> gtsam_fields(const ImuNoise& imu, double) {
  const auto n2 = [](const AxisNoise& axis) { return axis.n.value * axis.n.value; };
  const auto k2 = [](const AxisNoise& axis) { return axis.k.value * axis.k.value; };
  std::vector<Field> out;
  add_field(out, "accelerometerCovariance", imu.accelerometer, n2, "(m/s²)²/Hz", "N²");
  add_field(out, "biasAccCovariance", imu.accelerometer, k2, "(m/s³)²/Hz", "K²");
  add_field(out, "gyroscopeCovariance", imu.gyro, n2, "(rad/s)²/Hz", "N²");
  add_field(out, "biasOmegaCovariance", imu.gyro, k2, "(rad/s²)²/Hz", "K²");
  return out;
}

std::string gtsam_file(const Sheet& sheet) {
  std::string out = commented(sheet, "//") +
                    "#pragma once\n\n#include <gtsam/navigation/CombinedImuFactor.h>\n\n"
                    "inline void set_imu_noise(gtsam::PreintegrationCombinedParams& params) {\n";
  for (const Field& one : sheet.fields) {
    out += fmt::format("  // {}\n  params.{} = gtsam::Vector3{}.asDiagonal();\n", field_words(one),
                       one.key, value_list(one, "(", ", ", ")"));
  }
  return out + "}\n";
}

}  // namespace

const Consumer& gtsam() {
  static const Consumer kConsumer{
      .name = "gtsam",
      .title = "GTSAM",
      .file = "imu_noise.h",
      .holds = "white noise and random walk, a value for each axis",
      .axes = AxisRule::kEach,
      .remark =
          "biasAccOmegaInt, the covariance of the initial biases, is not noise: set it yourself "
          "(GTSAM removed it in 2025).",
      .fields = gtsam_fields,
      .write = gtsam_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
