#pragma once

// What the name of a column says: which sensor, which axis; and the patterns that choose columns.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/units.h"

namespace imunoise::recording {

/// What a column measures, as far as its name says so.
struct Role {
  Quantity quantity = Quantity::kUnknown;
  char axis = ' ';         ///< 'x', 'y', 'z', or a digit where the file counts its axes
  bool increment = false;  ///< an angle or a velocity gained over one period, not a rate
  std::string_view unit;   ///< that the name implies by a convention (REP 103 of ROS); else empty
  std::string sensor;      ///< what stands before, in small letters: "imu2" of imu2_gyro_x
};

/// "PacketCounter", "seq", "index": a column that counts rows.
bool is_counter_name(std::string_view name);

/// "imu_id", "sensor", "I": a column that says which sensor a row is of.
bool names_a_sensor(std::string_view name);

/// "Absolute acceleration", "acc_norm": a column of a vector's length.
bool is_norm_name(std::string_view name);

/// "wx", "gyr_x", "angular_velocity.x", "accelX", "linear_acceleration.z", "imu_temp", ...
Role role_of(std::string_view name);

/// How imunoise calls that column: "gyro_x", "acc_z", "temperature"; empty for an unknown role.
std::string common_name(const Role& role);

/// Whether `pattern` ('*' stands for any text, '?' for one character) matches the name, its common
/// name, or is another common name of the same axis ("gyr_x", "wx", "gyr_*").
bool matches(std::string_view pattern, std::string_view name);

/// "ax,ay,az" taken apart.
std::vector<std::string> split_names(std::string_view names);

}  // namespace imunoise::recording
