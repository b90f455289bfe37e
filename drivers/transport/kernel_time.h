#pragma once

// The kernel stamps samples by the time of day, which may be set; the host's clock never steps.

#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <optional>

#include "drivers/plugin/device.h"

namespace imunoise::transport {

/// From the kernel's stamps to the host's clock. Not thread-safe.
class KernelTime {
 public:
  /// Before samples are fetched that came together.
  void look(const plugin::Host& host) {
    const std::int64_t shift = read(host);
    was_set_ = shift_ns_ && std::llabs(shift - *shift_ns_) > kChance;
    if (!shift_ns_ || was_set_) shift_ns_ = shift;
  }
  /// When the time of day was set since the last look, their stamps are of before or after:
  /// they came now, as those without a stamp (0).
  std::int64_t host_time_ns(std::int64_t stamp_ns) const {
    return stamp_ns == 0 || was_set_ ? now_ns_ : stamp_ns + shift_ns_.value_or(0);
  }

 private:
  // Anew where the scheduler came between the readings.
  std::int64_t read(const plugin::Host& host) {
    for (int attempt = 1;; ++attempt) {
      const std::int64_t before = host.now_ns();
      timespec time{};
      ::clock_gettime(CLOCK_REALTIME, &time);
      now_ns_ = host.now_ns();
      if (now_ns_ - before > kQuick && attempt < kAttempts) continue;
      return now_ns_ - (std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec);
    }
  }

  static constexpr int kAttempts = 10;
  static constexpr std::int64_t kQuick = 100'000;      // ns
  static constexpr std::int64_t kChance = 20'000'000;  // ns, between reading two clocks
  std::optional<std::int64_t> shift_ns_;
  std::int64_t now_ns_ = 0;
  bool was_set_ = false;
};

}  // namespace imunoise::transport
