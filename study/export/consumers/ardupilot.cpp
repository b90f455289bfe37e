#include <fmt/format.h>

#include "study/export/consumers/autopilots.h"

namespace imunoise::study::consumers {
namespace {

std::vector<Field> ardupilot_fields(const ImuNoise& imu, double step) {
  return autopilot_fields(
      imu, step, {"EK3_GYRO_P_NSE", "EK3_GBIAS_P_NSE", "EK3_ACC_P_NSE", "EK3_ABIAS_P_NSE"});
}

std::string ardupilot_file(const Sheet& sheet) {
  std::string out = commented(sheet, "#");
  for (const Field& one : sheet.fields)
    out += fmt::format("# {}: {}\n{},{}\n", one.key, field_words(one), one.key, value_list(one));
  return out;
}

}  // namespace

const Consumer& ardupilot() {
  static const Consumer kConsumer{
      .name = "ardupilot",
      .title = "ArduPilot",
      .file = "imu.param",
      .holds = "white noise and random walk, one value for all axes",
      .remark = kNoVibration,
      .step = 0.012,
      .fields = ardupilot_fields,
      .write = ardupilot_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
