#pragma once

// A child process for what may crash, never end or ask for all memory: HDF5 on bytes from
// strangers. The library checks little of what it finds in a file.

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include "core/support/result.h"

namespace imunoise::recording {

/// One end of a two-way stream of bytes between two processes.
class Line {
 public:
  explicit Line(int descriptor) : descriptor_(descriptor) {}
  Line(Line&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Line& operator=(Line&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;
  ~Line();

  int descriptor() const { return descriptor_; }
  /// All of the bytes. False: the other end is closed, or `stopped` says so (asked ten times a
  /// second), or nothing came for as long as `patience`.
  bool send(std::span<const char> bytes) const;
  bool receive(std::span<char> bytes, const std::function<bool()>& stopped = nullptr,
               std::chrono::nanoseconds patience = std::chrono::nanoseconds::max()) const;

 private:
  int descriptor_ = -1;
};

/// A forked copy of this process with one thread. It ends with this object, or with its parent.
class LimitedChild {
 public:
  /// The child runs `work` with its end of the line and exits. Every other file is closed in it.
  /// `work` may call HDF5: no other thread was inside the library when the child was made. Locks of
  /// other threads may be held for ever, so it must take none (memory is no problem). Error: no
  /// process can be made.
  static Result<LimitedChild> start(const std::function<void(const Line&)>& work);
  LimitedChild(LimitedChild&& other) noexcept
      : pid_(std::exchange(other.pid_, -1)), line_(std::move(other.line_)) {}
  LimitedChild& operator=(LimitedChild&& other) noexcept {
    std::swap(pid_, other.pid_);
    std::swap(line_, other.line_);
    return *this;
  }
  LimitedChild(const LimitedChild&) = delete;
  LimitedChild& operator=(const LimitedChild&) = delete;
  ~LimitedChild();

  const Line& line() const { return line_; }
  /// What the child died of. Precondition: the line broke off. One that still lives is ended.
  std::string cause_of_death();

 private:
  LimitedChild(pid_t pid, Line line) : pid_(pid), line_(std::move(line)) {}
  int wait();
  bool ends_soon(int& status);

  pid_t pid_;
  Line line_;
};

/// In the child: limits its memory to what it has now and `bytes` more.
void limit_memory(std::uint64_t bytes);
/// In the child: limits the time that it computes from now on (s).
void limit_computing(std::uint64_t seconds);

}  // namespace imunoise::recording
