#pragma once

// What the name of a column says: which sensor, which axis; and the patterns that choose columns.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
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

/// "Absolute acceleration", "acc_norm": a column of a vector's length.
bool is_norm_name(std::string_view name);

/// The name of a time in seconds without that word ("header.stamp" of "header.stamp.sec"), and of
/// one in nanoseconds ("header.stamp.nanosec"), which may be all of it; none for any other name.
std::optional<std::string> stem_of_seconds(std::string_view name);
std::optional<std::string> stem_of_nanoseconds(std::string_view name);

/// "wx", "gyr_x", "angular_velocity.x", "accelX", "linear_acceleration.z", "imu_temp", ...
Role role_of(std::string_view name);

/// How imunoise calls that column: "gyro_x", "acc_z", "temperature"; empty for an unknown role.
std::string common_name(const Role& role);

/// Whether `pattern` ('*' stands for any text, '?' for one character) matches the name, its common
/// name, or is another common name of the same axis ("gyr_x", "wx", "gyr_*").
bool matches(std::string_view pattern, std::string_view name);

/// "ax,ay,az" taken apart.
std::vector<std::string> split_names(std::string_view names);

/// True for the names of time columns: t, time, timestamp, header.stamp, ... (any case), also with
/// _s, _ms, _us, _ns.
bool is_time_name(std::string_view name);

/// Seconds per stored number of a time column. `unit` is what the header states ("" for nothing:
/// then the name's suffix counts). Nothing when neither states a unit. Error: not a unit of time.
Result<std::optional<double>> time_unit(std::string_view name, std::string_view unit);

}  // namespace imunoise::recording
