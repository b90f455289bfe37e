#include "daemon/acquire/clock.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>

namespace imunoise::acquire {

Time SystemClock::now() const { return std::chrono::system_clock::now(); }

std::int64_t now_ns() { return SystemClock().now().time_since_epoch().count(); }

bool SystemClock::wait_until(Time time, const std::stop_token& stop) {
  constexpr std::chrono::seconds kSlice{10};  // after which a clock that was set is looked at anew
  std::mutex mutex;
  std::condition_variable_any nobody;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested() && now() < time) {
    const auto left = std::min<std::chrono::nanoseconds>(time - now(), kSlice);
    nobody.wait_for(lock, stop, left, [] { return false; });
  }
  return !stop.stop_requested();
}

}  // namespace imunoise::acquire
