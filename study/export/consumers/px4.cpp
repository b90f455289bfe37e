#include <fmt/format.h>

#include "study/export/consumers/autopilots.h"

namespace imunoise::study::consumers {
namespace {

std::vector<Field> px4_fields(const ImuNoise& imu, double step) {
  return autopilot_fields(
      imu, step, {"EKF2_GYR_NOISE", "EKF2_GYR_B_NOISE", "EKF2_ACC_NOISE", "EKF2_ACC_B_NOISE"});
}

// As QGroundControl loads it: vehicle, component, name, value, 9 for a float; tabs between them.
std::string px4_file(const Sheet& sheet) {
  std::string out = commented(sheet, "#");
  for (const Field& one : sheet.fields) {
    out += fmt::format("# {}: {}\n1\t1\t{}\t{}\t9\n", one.key, field_words(one), one.key,
                       value_list(one));
  }
  return out;
}

}  // namespace

const Consumer& px4() {
  static const Consumer kConsumer{
      .name = "px4",
      .title = "PX4",
      .file = "imu.params",
      .holds = "white noise and random walk, one value for all axes",
      .remark = kNoVibration,
      .step = 0.01,
      .fields = px4_fields,
      .write = px4_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
