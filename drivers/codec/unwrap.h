#pragma once

#include <cstdint>
#include <utility>

namespace imunoise::drivers {

/// A device's counter that starts again at zero after `modulus` steps, as one that never does.
class Unwrapper {
 public:
  explicit Unwrapper(std::int64_t modulus) : modulus_(modulus) {}

  /// The unwrapped count: whatever lies nearest to the last one, before or after it. The first
  /// counts as it is. `raw` is below the modulus.
  std::int64_t operator()(std::int64_t raw) {
    if (!std::exchange(started_, true)) return last_ = raw;
    std::int64_t step = (raw - last_) % modulus_;
    if (step < -modulus_ / 2) step += modulus_;
    if (step >= (modulus_ + 1) / 2) step -= modulus_;
    return last_ += step;
  }

  /// From now on the counter is known to go on to `modulus`.
  void widen(std::int64_t modulus) { modulus_ = modulus; }
  std::int64_t modulus() const { return modulus_; }

 private:
  std::int64_t modulus_;
  std::int64_t last_ = 0;
  bool started_ = false;
};

}  // namespace imunoise::drivers
