#pragma once

// Whether a device was recorded to the end that was planned.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "recording/store/recorder/recorder.h"

namespace imunoise::acquire {

/// How the recording of one device went.
struct DeviceCourse {
  const v1::RecordedDevice& device;
  const std::vector<recording::StreamCounts>& counts;  ///< Of its streams, after the last write.
  std::optional<double>
      last_s;  ///< When its last sample came, s from the beginning; unset: none did.
  std::uint64_t discarded = 0;  ///< Rows for which the disk left no room.
  std::string disk;             ///< What the disk said then.
  double from_s = 0.0;          ///< When it joined, s from the beginning.
};

/// What a device lacks of `planned_s` s: nothing if rows were stored to about the end (a tenth of
/// the time, between 1 s and 5 s, or 20 samples, may be missing there), or as many as the time
/// holds; if at least nine tenths of what its nominal rate promises before that end came, stored or
/// rejected; and no rows were discarded for want of room. A device that joined too late for 20
/// samples, or whose period is longer than the time, lacks nothing without any. Without a planned
/// end only the latter counts. Names the device.
std::string shortfall(const DeviceCourse& course, std::optional<double> planned_s);

}  // namespace imunoise::acquire
