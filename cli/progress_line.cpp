#include "cli/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "cli/output.h"
#include "study/words/number.h"

namespace imunoise::cli {

using namespace std::chrono_literals;

ProgressLine::ProgressLine(std::string what)
    : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) != 0), told_(begin_) {}

ProgressLine::~ProgressLine() {
  if (shown_ && terminal_) tell("\r\033[K");
}

void ProgressLine::report(double fraction) {
  const std::lock_guard lock(mutex_);
  furthest_ = std::max(furthest_, fraction);  // parallel parts may report out of order
  const Clock::time_point now = Clock::now();
  if (now - begin_ < 2s ||
      now - told_ < (terminal_ ? Clock::duration(100ms) : Clock::duration(10s)))
    return;
  told_ = now;
  shown_ = true;
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  const double left = furthest_ > 0.01 ? elapsed * (1.0 - furthest_) / furthest_ : 0.0;
  const std::string rest =
      furthest_ > 0.01 ? ", " + report::duration(std::max(left, 1.0)) + " left" : "";
  tell(fmt::format("{}{} {:.0f} %{}{}", terminal_ ? "\r\033[K" : "", what_, 100.0 * furthest_, rest,
                   terminal_ ? "" : "\n"));
}

}  // namespace imunoise::cli
