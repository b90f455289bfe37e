#pragma once

// Where the sensor did not lie still, found as the daemon finds it while it records.

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/units.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

/// Rows [begin, end) in which angular rates or accelerations were disturbed.
struct Motion {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::string channel;   ///< that showed it most
  double size = 0.0;     ///< in its usual scatter
  bool several = false;  ///< two channels or more at the same time: the sensor, not one channel

  /// `from` and `to` in seconds; `done`: "used" or "left out".
  std::string said(double from, double to, std::string_view done) const;
};

/// The columns of angular rates and accelerations, by their units, else by their names.
std::vector<std::size_t> channels_of_motion(const std::vector<Column>& columns,
                                            const std::vector<Unit>& units);

/// In order of time. `broken(row)`: a gap before this row, or a value that is missing in it. Blocks
/// of a second; the first half minute is judged backwards, from what follows it.
std::vector<Motion> motion_in(const std::vector<Column>& columns, const std::vector<Unit>& units,
                              Hertz rate, const std::function<bool(std::size_t)>& broken);

}  // namespace imunoise::recording
