#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/wavelet/prefix_sums.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise {

/// Wavelet variance of samples that arrive in pieces of any size. Memory is bounded by the largest
/// scale (about 3·2m sums), whatever the number of samples. Integers are summed exactly.
/// Sample is double, int16 or int32. Not thread-safe.
template <class Sample>
class StreamingVariance {
 public:
  /// Values in SI units are scale · sample.
  StreamingVariance(Scales scales, Hertz rate, Quantity quantity = Quantity::kUnknown,
                    double scale = 1.0);

  void push(std::span<const Sample> samples);

  std::size_t samples() const { return samples_; }

  /// The estimate from the samples so far, at the scales they support (2m ≤ T).
  WaveletVariance estimate(double confidence = 0.95) const;

 private:
  using Sum = std::conditional_t<std::is_same_v<Sample, double>, double, std::int64_t>;
  using Total = std::conditional_t<std::is_same_v<Sample, double>, double, Total128>;

  void add_new_sums(std::vector<Total>& totals) const;
  void make_room();

  Scales scales_;
  Hertz rate_;
  Quantity quantity_;
  double scale_;
  std::size_t reach_;        // 2m of the largest scale
  std::vector<Sum> window_;  // S_t for t = first_ .. , at least reach_ sums before the unused ones
  std::vector<Total> totals_;  // Σ (2m W)² up to S_used_
  std::size_t first_ = 0;      // t of window_[0]
  std::size_t used_ = 0;       // sums S_t with t < used_ are in totals_
  std::size_t samples_ = 0;
  Sample origin_{};
};

extern template class StreamingVariance<double>;
extern template class StreamingVariance<std::int16_t>;
extern template class StreamingVariance<std::int32_t>;

}  // namespace imunoise
