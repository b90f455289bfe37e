#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/wavelet/kernels.h"

namespace imunoise {

__extension__ using Total128 = unsigned __int128;

/// Prefix sums S_t = Σ_{u<t} (x_u - origin) of a borrowed signal, produced block by block from
/// checkpoints instead of being stored. S_t is the same bits wherever and however often it is asked
/// for; the origin (a constant, invisible to wavelets) keeps the sums small.
///
/// Sample / Sum: double / double; int16 or int32 / int32 (narrow) or int64 (wide). Integers are
/// exact.
template <class Sample, class Sum>
class PrefixSums {
 public:
  using SumType = Sum;
  /// Total of squared sums: double, or 128 bits for integers.
  using Total = std::conditional_t<std::is_same_v<Sum, double>, double, Total128>;

  explicit PrefixSums(std::span<const Sample> samples);

  /// Number of samples T; the sums are S_0 .. S_T.
  std::size_t samples() const { return samples_.size(); }

  /// Writes S_t for t in [block·kBlock, (block+1)·kBlock) ∩ [0, T] to out; returns how many.
  std::size_t fill(std::size_t block, Sum* out) const;

  /// Largest S_t minus smallest, from above. Integers only: tells whether the narrow form is safe.
  std::int64_t range_bound() const { return range_bound_; }

 private:
  std::span<const Sample> samples_;
  Sample origin_{};
  std::vector<Sum> checkpoints_;  // S at the start of each block
  std::int64_t range_bound_ = 0;
};

/// Adds Σ (a - 2b + c)² over n ≤ kBlock entries to the total.
void add_squares(const double* a, const double* b, const double* c, std::size_t n, double& total);
void add_squares(const std::int32_t* a, const std::int32_t* b, const std::int32_t* c, std::size_t n,
                 Total128& total);
void add_squares(const std::int64_t* a, const std::int64_t* b, const std::int64_t* c, std::size_t n,
                 Total128& total);

/// The largest range of S that the narrow (int32) form may have: |S_t - 2S_{t-m} + S_{t-2m}| ≤
/// 2^26.
inline constexpr std::int64_t kNarrowRange = std::int64_t{1} << 25U;

extern template class PrefixSums<double, double>;
extern template class PrefixSums<std::int16_t, std::int32_t>;
extern template class PrefixSums<std::int32_t, std::int32_t>;
extern template class PrefixSums<std::int16_t, std::int64_t>;
extern template class PrefixSums<std::int32_t, std::int64_t>;

}  // namespace imunoise
