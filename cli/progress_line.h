#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "core/support/progress.h"

namespace imunoise::cli {

/// Tells on standard error how far the work is and how long it will take, from the second second
/// on: one line that is rewritten on a terminal, a line every ten seconds elsewhere. Thread-safe.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  Progress progress(std::stop_token stop = {}) {
    return Progress([this](double fraction) { report(fraction); }, std::move(stop));
  }

 private:
  using Clock = std::chrono::steady_clock;

  void report(double fraction);

  std::mutex mutex_;
  std::string what_;
  bool terminal_;
  bool shown_ = false;
  double furthest_ = 0.0;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point told_;
};

}  // namespace imunoise::cli
