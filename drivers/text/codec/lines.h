#pragma once

// Bytes to lines.

#include <cstddef>
#include <string>
#include <string_view>

#include "drivers/codec/bytes.h"

namespace imunoise::text {

/// Puts lines together from pieces of any size. Memory is bounded: a line that is longer than
/// kLongestLine is cut there, and told as a line that no row looks like.
class LineReader {
 public:
  static constexpr std::size_t kLongestLine = 65'536;  // bytes

  /// Calls `take` with each line that these bytes end, without its end.
  template <class Take>
  void push(drivers::Bytes bytes, Take&& take) {
    for (const std::uint8_t byte : bytes) {
      if (byte == '\n') {
        take(std::string_view(line_));
        line_.clear();
      } else if (line_.size() <= kLongestLine) {
        line_.push_back(static_cast<char>(byte));
      }
    }
  }
  /// What came after the last end of a line.
  std::string_view rest() const { return line_; }
  void clear() { line_.clear(); }

 private:
  std::string line_;
};

}  // namespace imunoise::text
