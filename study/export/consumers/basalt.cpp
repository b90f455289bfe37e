#include <fmt/format.h>

#include "study/export/consumers/densities.h"

namespace imunoise::study::consumers {
namespace {

std::vector<Field> basalt_fields(const ImuNoise& imu, double) {
  return densities(imu, {"gyro_noise_std", "gyro_bias_std", "accel_noise_std", "accel_bias_std"});
}

std::string basalt_file(const Sheet& sheet) {
  std::string out = "{\n" + json_comment(sheet, "  ") + "  \"value0\": {\n" +
                    fmt::format("    \"imu_update_rate\": {:g}", rate_of(sheet.imu));
  for (const Field& one : sheet.fields)
    out += fmt::format(",\n    \"{}\": {}", one.key, value_list(one));
  return out + "\n  }\n}\n";
}

}  // namespace

const Consumer& basalt() {
  static const Consumer kConsumer{
      .name = "basalt",
      .title = "Basalt",
      .file = "calib.json",
      .holds = "white noise and random walk, a value for each axis",
      .axes = AxisRule::kEach,
      .remark = "Copy the values into value0 of your calib.json.",
      .fields = basalt_fields,
      .write = basalt_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
