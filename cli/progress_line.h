#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "core/support/progress.h"

namespace imunoise::cli {

/// Tells on standard error how far the work is and how long it will take, from the second second
/// on. On a terminal: one line with a bar, drawn anew four times a second, so that it moves even
/// while a step takes long. Elsewhere: a line every ten seconds. While another lives that was made
/// later, that one is shown. Thread-safe.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  Progress progress(std::stop_token stop = {}) {
    return Progress([this](double fraction) { report(fraction); }, std::move(stop));
  }

  /// Part `i` of `count` equal ones, which works on `what` ("gyro_x").
  Progress part(std::size_t i, std::size_t count, const std::string& what);

 private:
  using Clock = std::chrono::steady_clock;

  bool is_innermost() const { return level_ == lines_.load(); }
  void report(double fraction);
  void redraw(const std::stop_token& stop);
  std::string line(Clock::time_point now);

  inline static std::atomic<int> lines_ = 0;  // one within the other: the innermost is shown
  int level_ = ++lines_;
  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::string what_;
  bool terminal_;
  bool unicode_;
  bool shown_ = false;
  double furthest_ = 0.0;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point told_;
  std::jthread drawer_;  // last: it uses all others
};

}  // namespace imunoise::cli
