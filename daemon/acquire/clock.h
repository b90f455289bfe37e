#pragma once

// The time of day, and waiting: injected, so that tests run days in seconds.

#include <chrono>
#include <cstdint>
#include <stop_token>

namespace imunoise::acquire {

/// UTC.
using Time = std::chrono::time_point<std::chrono::system_clock, std::chrono::nanoseconds>;

/// The machine's: ns since 1970-01-01 UTC.
std::int64_t now_ns();

/// Thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Time now() const = 0;
  /// Waits until it is so late, or until somebody wants it to stop: then false. Follows the clock
  /// when somebody sets it.
  virtual bool wait_until(Time time, const std::stop_token& stop) = 0;
};

/// The machine's.
class SystemClock : public Clock {
 public:
  Time now() const override;
  bool wait_until(Time time, const std::stop_token& stop) override;
};

}  // namespace imunoise::acquire
