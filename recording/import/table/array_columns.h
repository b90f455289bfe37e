#pragma once

// How the columns of arrays with two dimensions are called, and which dimension is time. All
// formats with named arrays (HDF5, MATLAB, npz) share it.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "recording/import/table/options.h"

namespace imunoise::recording {

/// An array of rows times columns numbers.
struct Shape {
  std::uint64_t rows = 0;
  std::uint64_t columns = 1;

  std::uint64_t longer() const { return rows > columns ? rows : columns; }
  std::uint64_t shorter() const { return rows > columns ? columns : rows; }
  bool is_single() const { return rows == 1 && columns == 1; }
  /// Else it is a parameter: a rotation, a bias.
  bool may_be_recorded() const { return longer() >= kMinimumSamples; }
};

/// "gyro_x", "gyro_y", "gyro_z" for three columns of a sensor, else "data_1", "data_2", ...; a
/// single column has the array's own name.
std::vector<std::string> column_names(std::string_view array, std::uint64_t columns);

/// How many samples most columns have; parameters count only where nothing else is there. Time is
/// the dimension of that length, else the longer one.
std::uint64_t common_length(const std::vector<Shape>& shapes);

/// The number of hertz, where an array of one number is a sampling rate (fs, rate_hz) or a period
/// (dt, Ts) by its name; else 0.
double rate_called(std::string_view name, double value);

/// Whether numbers can be times: every step is above 0, and 90 % of them lie within half of the
/// median step. Numbers of 1, 2, 3, ... do not count: they are an index.
bool rises_steadily(const std::vector<double>& numbers);

/// What stands behind the last dot or slash: "t" of "imu.t".
std::string_view last_part(std::string_view name);

}  // namespace imunoise::recording
