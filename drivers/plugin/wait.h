#pragma once

// Waiting that a cancel ends at once.

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <stop_token>
#include <system_error>

namespace imunoise::plugin {

/// Set once, from any thread, and never taken back.
class CancelSignal {
 public:
  CancelSignal() : descriptor_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  }
  CancelSignal(const CancelSignal&) = delete;
  CancelSignal& operator=(const CancelSignal&) = delete;
  ~CancelSignal() { ::close(descriptor_); }

  void set() noexcept {
    set_.request_stop();
    const std::uint64_t one = 1;
    // Fails only where the counter is full, and then it is readable already.
    [[maybe_unused]] const ssize_t written = ::write(descriptor_, &one, sizeof one);
  }
  bool is_set() const noexcept { return set_.stop_requested(); }
  /// The same for libraries that take one.
  std::stop_token token() const noexcept { return set_.get_token(); }
  /// Readable from set() on.
  int descriptor() const noexcept { return descriptor_; }

 private:
  int descriptor_;
  std::stop_source set_;
};

/// How long a read may wait: until its deadline, or until it is cancelled.
class Wait {
 public:
  using Clock = std::chrono::steady_clock;

  Wait(const CancelSignal& signal, std::chrono::milliseconds timeout)
      : signal_(signal), deadline_(Clock::now() + timeout) {}

  bool cancelled() const { return signal_.is_set(); }
  /// Time is up, or the read was cancelled: return what there is.
  bool over() const { return cancelled() || Clock::now() >= deadline_; }
  Clock::time_point deadline() const { return deadline_; }

  /// Sleeps until `moment`. False where the deadline or a cancel came before.
  bool until(Clock::time_point moment) const {
    poll_until(-1, 0, std::min(moment, deadline_));
    return !cancelled() && Clock::now() >= moment;
  }
  /// Waits until `descriptor` can be read or is hung up (then read() says so). False where the
  /// deadline or a cancel came before. For other events of poll(2) name them.
  bool ready(int descriptor, short events = POLLIN) const {
    return poll_until(descriptor, events, deadline_) && !cancelled();
  }

 private:
  // True where `descriptor` has an event; a negative one never has.
  bool poll_until(int descriptor, short events, Clock::time_point moment) const {
    std::array<pollfd, 2> both = {{{signal_.descriptor(), POLLIN, 0}, {descriptor, events, 0}}};
    for (;;) {
      const auto left = std::chrono::ceil<std::chrono::nanoseconds>(moment - Clock::now());
      const auto nanoseconds = std::max<std::int64_t>(0, left.count());
      const timespec most = {nanoseconds / 1'000'000'000, nanoseconds % 1'000'000'000};
      const int count = ::ppoll(both.data(), both.size(), &most, nullptr);
      if (count >= 0) return both[1].revents != 0;
      if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "ppoll");
    }
  }

  const CancelSignal& signal_;
  Clock::time_point deadline_;
};

}  // namespace imunoise::plugin
