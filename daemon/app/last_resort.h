#pragma once

// Ends the program although a disk hangs.

#include <condition_variable>
#include <mutex>
#include <thread>

#include "daemon/app/log.h"
#include "daemon/app/supervisor.h"

namespace imunoise::app {

/// A disk that hangs holds up threads that no program can end. Once the program is about to end,
/// they are waited for, but not for ever; a disk that is only slow comes to its end. It lives until
/// all threads have ended that may be held up.
class LastResort {
 public:
  LastResort(const Supervisor& supervisor, Log& log) : supervisor_(supervisor), log_(log) {}

  /// Ends the program with status 3 after ten seconds, or as soon as something hangs for as long.
  /// More than once: the first call counts.
  void begin();

 private:
  void watch(const std::stop_token& stop);

  const Supervisor& supervisor_;
  Log& log_;
  std::mutex mutex_;
  std::condition_variable_any over_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace imunoise::app
