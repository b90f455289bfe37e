#pragma once

// Progress: how far a long computation is, and a way to stop it.

#include <functional>
#include <stop_token>
#include <utility>

namespace imunoise {

/// Handed to everything that can take seconds. Copies share the callback. The callback may be
/// called from any thread, must be thread-safe, and must not throw.
class Progress {
 public:
  using Callback = std::function<void(double fraction)>;

  Progress() = default;
  explicit Progress(Callback callback, std::stop_token stop = {})
      : callback_(std::move(callback)), stop_(std::move(stop)) {}

  /// Reports a fraction done in [0, 1].
  void report(double fraction) const {
    if (callback_) callback_(begin_ + (end_ - begin_) * fraction);
  }

  /// True when the caller wants the work to end early.
  bool stopped() const { return stop_.stop_requested(); }
  /// For what can be told to stop while it waits.
  const std::stop_token& stop_token() const { return stop_; }

  /// The same progress, restricted to a part of the whole: fraction f is told as begin + (end -
  /// begin)·f.
  Progress part(double begin, double end) const {
    Progress out = *this;
    out.begin_ = begin_ + (end_ - begin_) * begin;
    out.end_ = begin_ + (end_ - begin_) * end;
    return out;
  }

 private:
  Callback callback_;
  std::stop_token stop_;
  double begin_ = 0.0;
  double end_ = 1.0;
};

}  // namespace imunoise
