#pragma once

// A time of day that a test sets: this program's calls of clock_gettime() come here. For one source
// of a program.

#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <ctime>

namespace {
std::atomic<std::int64_t> set_by_s = 0;  // NOLINT: the C library's function has no object
}  // namespace

extern "C" int clock_gettime(clockid_t id, timespec* time) noexcept {
  const auto result = static_cast<int>(::syscall(SYS_clock_gettime, id, time));
  if (id == CLOCK_REALTIME) time->tv_sec += set_by_s;
  return result;
}
