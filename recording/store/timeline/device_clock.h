#pragma once

// A device's clock against the host's.

#include <cstdint>
#include <optional>
#include <span>

#include "imunoise/v1/recording.pb.h"
#include "recording/store/timeline/straight_line.h"

namespace imunoise::recording {

/// Compares the times of one stream's samples by both clocks. A sample comes late by its way to the
/// host, and never early: of each second (or each sample, if they are rarer) the one that came
/// earliest counts, and a straight line through these tells how fast the device's clock runs. Where
/// the device's clock begins anew, the longest stretch counts. Not thread-safe.
class DeviceClock {
 public:
  /// (n) times of consecutive samples, ns; the device's of any origin.
  void take(std::span<const std::int64_t> host_ns, std::span<const std::int64_t> device_ns);
  /// The device's clock begins anew.
  void restart();
  /// Without device and stream; nothing while fewer than ten seconds are known.
  std::optional<v1::ClockComparison> comparison() const;

 private:
  struct Stretch {
    std::int64_t device_origin_ns = 0;
    std::int64_t delay_origin_ns = 0;  // host - device of the first sample
    StraightLine earliest;             // s by the device, and what the host is late by, s
    StraightLine all;
    std::int64_t window = -1;  // the second that is being looked at
    double window_x = 0.0;
    double window_y = 0.0;
  };
  const Stretch& longest() const;

  Stretch now_;
  Stretch best_;
};

}  // namespace imunoise::recording
