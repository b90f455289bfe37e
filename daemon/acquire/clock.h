#pragma once

// The time of day, and waiting: injected, so that tests run days in seconds.

#include <chrono>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>

namespace imunoise::acquire {

/// UTC.
using Time = std::chrono::time_point<std::chrono::system_clock, std::chrono::nanoseconds>;

/// ns since 1970-01-01 UTC.
inline std::int64_t ns(Time time) { return time.time_since_epoch().count(); }

/// The machine's: ns since 1970-01-01 UTC.
std::int64_t now_ns();

/// Thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;
  /// The time of day, which may be wrong, and may be set at any time.
  virtual Time now() const = 0;
  /// Since the machine started, sleep included. Setting the time of day does not move it.
  virtual std::chrono::nanoseconds since_boot() const = 0;
  /// Names this run of the machine; empty when unknown.
  virtual std::string boot_id() const = 0;
  /// A time service (NTP, PTP) is known to keep the time of day right.
  virtual bool synchronised() const = 0;
  /// Waits until this time, or until the time of day is set, which the caller has to look at.
  /// False: `stop` was requested.
  virtual bool wait_until(Time time, const std::stop_token& stop) = 0;
};

/// The machine's.
class SystemClock : public Clock {
 public:
  Time now() const override;
  std::chrono::nanoseconds since_boot() const override;
  std::string boot_id() const override;
  bool synchronised() const override;
  bool wait_until(Time time, const std::stop_token& stop) override;
};

const Clock& system_clock();

/// Differences between two clocks below this are chance: the two are not read in one moment.
inline constexpr std::chrono::milliseconds kLeastLeap{50};

/// Notices when the time of day is set. Not thread-safe.
class LeapWatch {
 public:
  explicit LeapWatch(const Clock& clock);
  /// By how much the time of day was set since the last call, or since the beginning (> 0:
  /// forward); nothing when it was not.
  std::optional<std::chrono::nanoseconds> look();

 private:
  const Clock& clock_;
  std::chrono::nanoseconds offset_;  // from the time since boot to the time of day
};

/// "set forward by 2 h", "set back by 5 s"
std::string describe_leap(std::chrono::nanoseconds leap);

}  // namespace imunoise::acquire
