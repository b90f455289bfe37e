#pragma once

// Channels of the kernel's Industrial I/O subsystem as channels of imunoise. Source:
// Documentation/ABI/testing/sysfs-bus-iio of Linux.

#include <string>
#include <string_view>

#include "drivers/description.h"

namespace imunoise::iio {

/// What the kernel says of a channel: value = (number + offset) · scale, in the unit of its kind.
struct ScanChannel {
  std::string id;  ///< "anglvel_x"
  double scale = 1.0;
  double offset = 0.0;
  unsigned bits = 16;
  bool is_signed = true;
};

/// anglvel_x → gyro_x (rad/s), accel_x → acc_x (m/s²), magn_x → mag_x (gauss), temp → temperature
/// (°C), pressure (kPa → Pa); others keep their name and have no unit.
drivers::Channel describe_channel(const ScanChannel& channel);

/// An angular rate, acceleration or magnetic field: a device with one is an IMU, or a part of one.
bool is_inertial(std::string_view id);

}  // namespace imunoise::iio
