#pragma once

// The daemon's log: one line a fact, to the journal where systemd started it, else to standard
// error.

#include <memory>
#include <mutex>
#include <string>

#include "daemon/app/rate_limit.h"

namespace spdlog {
class logger;
}

namespace imunoise::app {

/// Thread-safe.
class Log {
 public:
  Log();

  void fact(const std::string& text);
  void warning(const std::string& text);
  void error(const std::string& text);
  /// A fact that a source may tell often: at most 20 of each in a minute.
  void chatter(const std::string& source, const std::string& text);

 private:
  std::shared_ptr<spdlog::logger> logger_;
  std::mutex mutex_;
  RateLimit limit_;
};

}  // namespace imunoise::app
