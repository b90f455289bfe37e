#include <fmt/format.h>

#include "study/export/consumer.h"

namespace imunoise::study::consumers {
namespace {

std::vector<Field> ros_fields(const ImuNoise& imu, double) {
  const auto variance = [](const AxisNoise& axis) {
    return axis.n.value * axis.n.value * axis.rate.value;
  };
  std::vector<Field> out;
  add_field(out, "angular_velocity_covariance", imu.gyro, variance, "(rad/s)²",
            "N²·f on the diagonal, " + rate_words(imu.gyro));
  add_field(out, "linear_acceleration_covariance", imu.accelerometer, variance, "(m/s²)²",
            "N²·f on the diagonal, " + rate_words(imu.accelerometer));
  return out;
}

std::string ros_file(const Sheet& sheet) {
  std::string out = commented(sheet, "#");
  for (const Field& one : sheet.fields) {
    out += fmt::format("{}: [{:.7g}, 0, 0, 0, {:.7g}, 0, 0, 0, {:.7g}]  # {}\n", one.key,
                       one.values[0].value, one.values[1].value, one.values[2].value,
                       field_words(one));
  }
  return out;
}

}  // namespace

const Consumer& ros() {
  static const Consumer kConsumer{
      .name = "ros",
      .title = "ROS sensor_msgs/Imu, robot_localization",
      .file = "imu.yaml",
      .holds = "white noise, a value for each axis; no random walk",
      .axes = AxisRule::kEach,
      .takes_walk = false,
      .remark = "A first element of -1 would mean that the sensor has no such output.",
      .fields = ros_fields,
      .write = ros_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
