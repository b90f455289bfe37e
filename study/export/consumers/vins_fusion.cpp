#include <cmath>

#include "study/export/consumer.h"

namespace imunoise::study::consumers {
namespace {

// Midpoint integration draws two white numbers a step and takes their mean; biases step by w·dt.
std::vector<Field> vins_fields(const ImuNoise& imu, double) {
  const auto n = [](const AxisNoise& axis) {
    return axis.n.value * std::sqrt(2.0 * axis.rate.value);
  };
  const auto w = [](const AxisNoise& axis) { return axis.k.value * std::sqrt(axis.rate.value); };
  std::vector<Field> out;
  add_field(out, "acc_n", imu.accelerometer, n, "m/s²",
            "N·√(2f), " + rate_words(imu.accelerometer));
  add_field(out, "acc_w", imu.accelerometer, w, "m/s³", "K·√f, " + rate_words(imu.accelerometer));
  add_field(out, "gyr_n", imu.gyro, n, "rad/s", "N·√(2f), " + rate_words(imu.gyro));
  add_field(out, "gyr_w", imu.gyro, w, "rad/s²", "K·√f, " + rate_words(imu.gyro));
  return out;
}

}  // namespace

const Consumer& vins_fusion() {
  static const Consumer kConsumer{
      .name = "vins-fusion",
      .title = "VINS-Fusion",
      .file = "config.yaml",
      .holds = "white noise and random walk, one value for all axes",
      .remark = "Values hold for this sampling rate alone.",
      .fields = vins_fields,
      .write = yaml,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
