#pragma once

// The wavelet variance of one channel while it is recorded.

#include <cstddef>
#include <vector>

#include "core/wavelet/streaming_variance.h"

namespace imunoise::live {

/// What is known at one scale.
struct KnownScale {
  double tau_s = 0.0;     ///< Averaging time 2m / rate.
  double variance = 0.0;  ///< (SI unit)²
  double degrees = 0.0;   ///< Equivalent degrees of freedom.
};

/// Averaging times up to 2^26 samples in a megabyte: samples up to 2m = 1024, means of 256 samples
/// above, means of 65,536 above those. A coefficient of means is one of the samples' own; there are
/// fewer of them, which costs no degrees of freedom worth mentioning: neighbours say the same. A
/// gap ends a piece; what all pieces say is put together. Not thread-safe.
class LiveVariance {
 public:
  /// Values in SI units are scale · number.
  LiveVariance(Hertz rate, double scale);

  void push(double number);
  /// Samples are missing before the next one.
  void gap();
  /// At the dyadic scales that have been reached, ascending.
  std::vector<KnownScale> known() const;

 private:
  static constexpr std::size_t kLevels = 3;

  // Of one scale in some pieces.
  struct Total {
    double squares = 0.0;  // coefficients · variance
    double coefficients = 0.0;
    double degrees = 0.0;
  };
  struct Level {
    StreamingVariance<double> now;
    std::vector<Total> before;  // in the pieces that have ended
    double mean_sum = 0.0;      // of the values that become the next level's next
    std::size_t mean_count = 0;
  };
  StreamingVariance<double> fresh(std::size_t level) const;
  static std::vector<Total> total(const Level& level);
  void push(std::size_t level, double value);

  Hertz rate_;
  double scale_;
  std::vector<Level> levels_;
};

/// Degrees of freedom at which the ends of the 95 % interval of a deviation are a factor of two
/// apart.
inline constexpr double kEnoughDegrees = 17.0;

}  // namespace imunoise::live
