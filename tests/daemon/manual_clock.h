#pragma once

// A clock that jumps to whatever is waited for.

#include <stop_token>

#include "daemon/acquire/clock.h"

namespace imunoise::testing {

class ManualClock : public acquire::Clock {
 public:
  explicit ManualClock(acquire::Time begin) : now_(begin) {}
  acquire::Time now() const override { return now_; }
  bool wait_until(acquire::Time time, const std::stop_token& stop) override {
    if (stop.stop_requested()) return false;
    if (time > now_) now_ = time;
    if (now_ >= end_) source_.request_stop();
    return !stop.stop_requested();
  }

  void pass(std::chrono::nanoseconds time) { now_ += time; }
  /// From then on waiting ends with a stop.
  void stop_at(acquire::Time end) { end_ = end; }
  std::stop_source& source() { return source_; }

 private:
  acquire::Time now_;
  acquire::Time end_ = acquire::Time::max();
  std::stop_source source_;
};

}  // namespace imunoise::testing
