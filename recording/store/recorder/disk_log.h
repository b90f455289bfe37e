#pragma once

// Whether the disk under one device fails, and since when.

#include "recording/store/recorder/recorder.h"

namespace imunoise::recording {

/// Of calls of one kind. Not thread-safe: the recorder's lock guards it.
class DiskLog {
 public:
  void take(const Result<void>& done) {
    if (done) return trouble_.reset();
    if (!trouble_) {
      const auto now = std::chrono::system_clock::now().time_since_epoch();
      trouble_ = DiskTrouble{{},
                             std::chrono::steady_clock::now(),
                             std::chrono::duration_cast<std::chrono::nanoseconds>(now).count()};
    }
    trouble_->error = done.error();
    last_error_ = done.error();
    ++failures_;
  }

  /// While it lasts.
  const std::optional<DiskTrouble>& trouble() const { return trouble_; }
  std::uint64_t failures() const { return failures_; }
  /// Of the last failure, also when it is over. Without a failure: empty.
  const Error& last_error() const { return last_error_; }

 private:
  std::optional<DiskTrouble> trouble_;
  Error last_error_;
  std::uint64_t failures_ = 0;
};

}  // namespace imunoise::recording
