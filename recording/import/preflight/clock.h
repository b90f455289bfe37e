#pragma once

// The unit of a time column, and its stamps in seconds.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "recording/import/table/time_column.h"

namespace imunoise::recording {

/// Stamps in seconds after the first. Borrows the column. Thread-safe to read.
class Clock {
 public:
  /// `unit` (s per number) is the user's; unset: the column's, its name's, or what values and steps
  /// show: numbers that are dates since 1970, or days of a spreadsheet or of MATLAB, else the unit
  /// whose rate is the nearest to 200 Hz, and seconds for steps up to 1. `place` is for messages.
  /// Error: an unknown unit, fewer than two stamps, one that is missing, stamps that never rise, or
  /// a rate of more than 1 MHz.
  static Result<Clock> read(const std::string& place, const TimeColumn& column,
                            std::optional<double> unit);

  std::size_t size() const { return size_; }
  /// s
  double at(std::size_t i) const {
    return whole_ != nullptr ? static_cast<double>(since(i)) * unit_
                             : (numbers_[i] - numbers_[0]) * unit_;
  }
  double step(std::size_t i) const { return at(i) - at(i - 1); }
  /// s; what a stamp is rounded to at least.
  double rounding() const { return rounding_; }
  /// "column t, milliseconds (by its steps)"
  const std::string& said() const { return said_; }
  /// Why the unit may be another one; empty: it is stated, or the rate is usual.
  const std::string& doubt() const { return doubt_; }
  /// Whether stamps show each sample's own time: nearly all steps are one period within a tenth.
  bool even() const { return even_; }
  /// Whether samples are lost throughout: no stretch of 64 is without a longer step.
  bool loses() const { return loses_; }
  /// The mean step of most of the blocks of the column (s), or of most steps where each block has
  /// lost samples: gaps and bursts hardly change it.
  double period() const { return period_; }

 private:
  // Finds even stamps, and lost samples among them.
  void follow_single_steps();

  // Stamps of a damaged file may lie further apart than int64 can say: they wrap.
  std::int64_t since(std::size_t i) const {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(whole_[i]) -
                                     static_cast<std::uint64_t>(whole_[0]));
  }

  const double* numbers_ = nullptr;
  const std::int64_t* whole_ = nullptr;
  std::size_t size_ = 0;
  double unit_ = 1.0;
  double rounding_ = 0.0;
  double period_ = 0.0;
  bool even_ = false;
  bool loses_ = false;
  std::string said_;
  std::string doubt_;
};

}  // namespace imunoise::recording
