#include "study/export/consumer.h"

namespace imunoise::study::consumers {
namespace {

// The filter multiplies these covariances by dt² at each sample.
std::vector<Field> fast_lio_fields(const ImuNoise& imu, double) {
  const auto n = [](const AxisNoise& axis) {
    return axis.n.value * axis.n.value * axis.rate.value;
  };
  const auto k = [](const AxisNoise& axis) {
    return axis.k.value * axis.k.value * axis.rate.value;
  };
  std::vector<Field> out;
  add_field(out, "acc_cov", imu.accelerometer, n, "(m/s²)²",
            "N²·f, " + rate_words(imu.accelerometer));
  add_field(out, "gyr_cov", imu.gyro, n, "(rad/s)²", "N²·f, " + rate_words(imu.gyro));
  add_field(out, "b_acc_cov", imu.accelerometer, k, "(m/s³)²",
            "K²·f, " + rate_words(imu.accelerometer));
  add_field(out, "b_gyr_cov", imu.gyro, k, "(rad/s²)²", "K²·f, " + rate_words(imu.gyro));
  return out;
}

std::string fast_lio_file(const Sheet& sheet) { return yaml_under("mapping", sheet); }

}  // namespace

const Consumer& fast_lio() {
  static const Consumer kConsumer{
      .name = "fast-lio",
      .title = "FAST-LIO",
      .file = "config.yaml",
      .holds = "white noise and random walk, one value for all axes",
      .remark = "Values hold for this sampling rate alone.",
      .fields = fast_lio_fields,
      .write = fast_lio_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
