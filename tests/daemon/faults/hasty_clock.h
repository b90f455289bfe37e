#pragma once

#include <algorithm>

#include "daemon/acquire/clock.h"

namespace imunoise::testing {

/// Whoever waits, for the schedule or after trouble, has waited already.
class HastyClock : public acquire::SystemClock {
 public:
  acquire::Time now() const override { return SystemClock::now() + skipped_; }
  std::chrono::nanoseconds since_boot() const override {
    return SystemClock::since_boot() + skipped_;
  }
  bool wait_until(acquire::Time time, const std::stop_token& stop) override {
    skipped_ += std::max<std::chrono::nanoseconds>(time - now(), std::chrono::nanoseconds(0));
    return !stop.stop_requested();
  }

 private:
  std::chrono::nanoseconds skipped_{0};
};

}  // namespace imunoise::testing
