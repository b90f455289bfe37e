#pragma once

#include <cmath>
#include <cstdint>

#include "drivers/plugin.h"

namespace imunoise::replay {

/// How fast samples come.
struct Pace {
  double speed = 1.0;      ///< Relative to real time; 0 is as fast as possible.
  double latency_s = 0.0;  ///< Samples come in groups, this often in real time; 0: one by one.
};

/// The option "speed" of drivers that replay.
inline drivers::Option speed_option() {
  return {.name = "speed",
          .type = drivers::OptionType::kNumber,
          .description = "Speed relative to real time; 0 is as fast as possible",
          .by_default = "1",
          .minimum = 0.0,
          .maximum = 1e9};
}

/// From the time line of a recording to that of its replay.
class Timeline {
 public:
  using Clock = plugin::Wait::Clock;

  /// Begins now.
  Timeline(Pace pace, const plugin::Host& host)
      : pace_(pace), start_ns_(host.now_ns()), start_(Clock::now()) {}

  const Pace& pace() const { return pace_; }
  bool at_once() const { return pace_.speed == 0.0; }
  /// Host time of what was recorded `since_begin_ns` after the first sample, whatever the speed.
  std::int64_t host_time_ns(std::int64_t since_begin_ns) const {
    return start_ns_ + since_begin_ns;
  }
  /// When that is due. Precondition: not at_once().
  Clock::time_point due(double since_begin_s) const {
    return start_ + std::chrono::nanoseconds(std::llround(since_begin_s / pace_.speed * 1e9));
  }

 private:
  Pace pace_;
  std::int64_t start_ns_;    // host time of the first sample
  Clock::time_point start_;  // the same moment of the clock that waits
};

}  // namespace imunoise::replay
