#include "daemon/acquire/clock.h"

#include <fmt/format.h>
#include <sys/timex.h>

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <mutex>

#include "daemon/config/quantity_text.h"

namespace imunoise::acquire {
namespace {

using std::chrono::nanoseconds;

// From the time since boot to the time of day. Read anew where the scheduler came between.
nanoseconds offset_of(const Clock& clock) {
  constexpr int kAttempts = 10;
  for (int attempt = 1;; ++attempt) {
    const nanoseconds before = clock.since_boot();
    const nanoseconds now = clock.now().time_since_epoch();
    const nanoseconds after = clock.since_boot();
    if (after - before < kLeastLeap / 10 || attempt == kAttempts) {
      return now - (before + after) / 2;
    }
  }
}

// Without /proc/sys, which a confined service does not see, its unit tells.
std::string read_boot_id() {
  std::string out;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> out;
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing of ours changes the environment.
  const char* const told = std::getenv("IMUNOISE_BOOT_ID");
  if (out.empty() && told != nullptr) out = told;
  std::erase(out, '-');
  return out;
}

}  // namespace

Time SystemClock::now() const { return std::chrono::system_clock::now(); }

std::int64_t now_ns() { return SystemClock().now().time_since_epoch().count(); }

nanoseconds SystemClock::since_boot() const {
  timespec time{};
  ::clock_gettime(CLOCK_BOOTTIME, &time);
  return std::chrono::seconds(time.tv_sec) + nanoseconds(time.tv_nsec);
}

std::string SystemClock::boot_id() const {
  static const std::string kId = read_boot_id();
  return kId;
}

bool SystemClock::synchronised() const {
  timex state{};
  const int found = ::ntp_adjtime(&state);
  if (found >= 0) return found != TIME_ERROR && (state.status & STA_UNSYNC) == 0;
  // ProtectClock= forbids even to ask the kernel; systemd-timesyncd leaves this file.
  std::error_code ignored;
  return std::filesystem::exists("/run/systemd/timesync/synchronized", ignored);
}

bool SystemClock::wait_until(Time time, const std::stop_token& stop) {
  constexpr std::chrono::seconds kSlice{10};  // after which a clock that was set is looked at anew
  std::mutex mutex;
  std::condition_variable_any never_notified;
  std::unique_lock lock(mutex);
  LeapWatch leaps(*this);
  while (!stop.stop_requested() && now() < time) {
    const auto left = std::min<nanoseconds>(time - now(), kSlice);
    never_notified.wait_for(lock, stop, left, [] { return false; });
    if (leaps.look()) break;
  }
  return !stop.stop_requested();
}

const Clock& system_clock() {
  static const SystemClock kClock;
  return kClock;
}

LeapWatch::LeapWatch(const Clock& clock) : clock_(clock), offset_(offset_of(clock)) {}

std::optional<nanoseconds> LeapWatch::look() {
  const nanoseconds now = offset_of(clock_);
  const nanoseconds leap = now - offset_;
  if (std::chrono::abs(leap) < kLeastLeap) return std::nullopt;
  offset_ = now;
  return leap;
}

std::string describe_leap(nanoseconds leap) {
  const double seconds = std::chrono::duration<double>(std::chrono::abs(leap)).count();
  return fmt::format("set {} by {}", leap > nanoseconds::zero() ? "forward" : "back",
                     config::print_duration(seconds));
}

}  // namespace imunoise::acquire
