#pragma once

// How long to wait before a disk that failed is tried again.

#include <algorithm>
#include <chrono>
#include <utility>

namespace imunoise::recording {

/// 50 ms, then twice as long each time, up to 2 s.
class BackOff {
 public:
  std::chrono::milliseconds next() {
    return std::exchange(pause_, std::min(2 * pause_, std::chrono::milliseconds(2000)));
  }
  /// The disk works again.
  void reset() { pause_ = kFirst; }

 private:
  static constexpr std::chrono::milliseconds kFirst{50};
  std::chrono::milliseconds pause_ = kFirst;
};

}  // namespace imunoise::recording
