#pragma once

// A clock that jumps to whatever is waited for.

#include <algorithm>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "daemon/acquire/clock.h"

namespace imunoise::testing {

class ManualClock : public acquire::Clock {
 public:
  /// The machine started on 2026-02-28.
  explicit ManualClock(acquire::Time begin)
      : now_(begin),
        since_boot_(begin -
                    acquire::Time(std::chrono::sys_days(std::chrono::year(2026) / 2 / 28))) {}
  acquire::Time now() const override { return now_; }
  std::chrono::nanoseconds since_boot() const override { return since_boot_; }
  std::string boot_id() const override { return boot_id_; }
  bool synchronised() const override { return synchronised_; }
  bool wait_until(acquire::Time time, const std::stop_token& stop) override {
    if (stop.stop_requested()) return false;
    const bool leaps = leap_at_ && time >= leap_at_->first;
    if (leaps) time = leap_at_->first;
    if (time > now_) pass(std::min(time - now_, last_ - since_boot_));
    if (since_boot_ >= last_) return !source_.request_stop();
    if (leaps) leap(std::exchange(leap_at_, std::nullopt)->second);
    if (now_ >= end_) source_.request_stop();
    return !stop.stop_requested();
  }

  void pass(std::chrono::nanoseconds time) {
    now_ += time;
    since_boot_ += time;
  }
  /// Somebody sets the time of day.
  void leap(std::chrono::nanoseconds by) { now_ += by; }
  /// Somebody does while this time is waited for.
  void leap_at(acquire::Time time, std::chrono::nanoseconds by) { leap_at_ = {time, by}; }
  void set_boot(const std::string& id, std::chrono::nanoseconds since) {
    boot_id_ = id;
    since_boot_ = since;
  }
  void set_synchronised(bool yes) { synchronised_ = yes; }
  /// From then on waiting ends with a stop.
  void stop_at(acquire::Time end) { end_ = end; }
  /// Once so much more time has passed, waiting ends with a stop.
  void stop_after(std::chrono::nanoseconds time) {
    last_ = since_boot_ + time;
    source_ = std::stop_source();
  }
  std::stop_source& source() { return source_; }

 private:
  acquire::Time now_;
  std::chrono::nanoseconds since_boot_;
  std::string boot_id_ = "boot";
  bool synchronised_ = true;
  std::optional<std::pair<acquire::Time, std::chrono::nanoseconds>> leap_at_;
  acquire::Time end_ = acquire::Time::max();
  std::chrono::nanoseconds last_ = std::chrono::nanoseconds::max();
  std::stop_source source_;
};

}  // namespace imunoise::testing
