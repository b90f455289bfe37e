#include "cli/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "cli/output.h"
#include "study/words/number.h"

namespace imunoise::cli {

using namespace std::chrono_literals;

namespace {

constexpr auto kQuiet = 2s;          // shorter work tells nothing
constexpr auto kBetweenLines = 10s;  // where there is no terminal
constexpr auto kBetweenDraws = 250ms;

std::string bar(double fraction, bool unicode) {
  constexpr int width = 20;
  const int full = static_cast<int>(std::lround(std::clamp(fraction, 0.0, 1.0) * width));
  std::string out;
  for (int i = 0; i < width; ++i) out += i < full ? (unicode ? "━" : "#") : (unicode ? "┄" : ".");
  return out;
}

}  // namespace

ProgressLine::ProgressLine(std::string what)
    : what_(std::move(what)),
      terminal_(isatty(STDERR_FILENO) != 0),
      unicode_(terminal_style().unicode),
      told_(begin_) {
  if (terminal_) drawer_ = std::jthread([this](const std::stop_token& stop) { redraw(stop); });
}

ProgressLine::~ProgressLine() {
  if (drawer_.joinable()) {
    drawer_.request_stop();
    drawer_.join();
  }
  if (shown_ && terminal_) tell("\r\033[K");
  --lines_;
}

Progress ProgressLine::part(std::size_t i, std::size_t count, const std::string& what) {
  {
    const std::lock_guard lock(mutex_);
    what_ = count > 1 ? fmt::format("{} ({} of {})", what, i + 1, count) : what;
  }
  const auto all = static_cast<double>(count);
  return progress().part(static_cast<double>(i) / all, static_cast<double>(i + 1) / all);
}

std::string ProgressLine::line(Clock::time_point now) {
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  const double left = furthest_ > 0.01 ? elapsed * (1.0 - furthest_) / furthest_ : 0.0;
  const std::string rest =
      furthest_ > 0.01 ? ", about " + report::duration(std::max(left, 1.0)) + " left" : "";
  if (!terminal_) return fmt::format("{} {:.0f} %{}\n", what_, 100.0 * furthest_, rest);
  return fmt::format("\r\033[K{} {} {:.0f} %, {:.0f} s{}", what_, bar(furthest_, unicode_),
                     100.0 * furthest_, elapsed, rest);
}

void ProgressLine::redraw(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, stop, kBetweenDraws, [&] { return stop.stop_requested(); })) {
    const Clock::time_point now = Clock::now();
    if (now - begin_ < kQuiet || !is_innermost()) continue;
    shown_ = true;
    tell(line(now));
  }
}

void ProgressLine::report(double fraction) {
  const std::lock_guard lock(mutex_);
  furthest_ = std::max(furthest_, fraction);  // parallel parts may report out of order
  const Clock::time_point now = Clock::now();
  if (terminal_ || now - begin_ < kQuiet || now - told_ < kBetweenLines) return;
  told_ = now;
  tell(line(now));
}

}  // namespace imunoise::cli
