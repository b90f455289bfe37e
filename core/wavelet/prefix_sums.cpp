#include "core/wavelet/prefix_sums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace imunoise {
namespace {

// Σ x over one block; doubles in fixed lanes, integers exactly.
double block_sum(std::span<const double> x) {
  std::array<double, 16> lanes{};
  std::size_t i = 0;
  for (; i + lanes.size() <= x.size(); i += lanes.size()) {
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) lanes[lane] += x[i + lane];
  }
  double sum = 0.0;
  for (const double lane : lanes) sum += lane;
  for (; i < x.size(); ++i) sum += x[i];
  return sum;
}

Extent extent(std::span<const std::int16_t> x) {
  Extent out{};
  kernels().extent_int16(x.data(), x.size(), &out);
  return out;
}

Extent extent(std::span<const std::int32_t> x) {
  Extent out{};
  kernels().extent_int32(x.data(), x.size(), &out);
  return out;
}

template <class Sample>
std::int64_t block_sum(std::span<const Sample> x) {
  return extent(x).sum;
}

// A value near the mean, from up to 64 blocks spread over the signal.
template <class Sample>
Sample origin_of(std::span<const Sample> samples) {
  const std::size_t blocks = (samples.size() + kBlock - 1) / kBlock;
  const std::size_t stride = std::max<std::size_t>(1, blocks / 64);
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t block = 0; block < blocks; block += stride) {
    const auto part =
        samples.subspan(block * kBlock, std::min(kBlock, samples.size() - block * kBlock));
    sum += static_cast<double>(block_sum(part));
    count += part.size();
  }
  const double mean = count > 0 ? sum / static_cast<double>(count) : 0.0;
  if constexpr (std::is_integral_v<Sample>) {
    return static_cast<Sample>(std::lround(mean));
  } else {
    return mean;
  }
}

// Running sum of block sums in twice the working precision (Knuth's two-sum).
class CompensatedSum {
 public:
  void add(double value) {
    const double next = high_ + value;
    const double shadow = next - high_;
    low_ += (high_ - (next - shadow)) + (value - shadow);
    high_ = next;
  }
  double value() const { return high_ + low_; }

 private:
  double high_ = 0.0;
  double low_ = 0.0;
};

}  // namespace

template <class Sample, class Sum>
PrefixSums<Sample, Sum>::PrefixSums(std::span<const Sample> samples)
    : samples_(samples), origin_(origin_of(samples)) {
  const std::size_t blocks = samples.size() / kBlock + 1;
  checkpoints_.reserve(blocks);
  if constexpr (std::is_same_v<Sum, double>) {
    CompensatedSum sum;
    for (std::size_t block = 0; block < blocks; ++block) {
      checkpoints_.push_back(sum.value());
      const std::size_t at = block * kBlock;
      const auto part = samples.subspan(at, std::min(kBlock, samples.size() - at));
      sum.add(block_sum(part));
      sum.add(-origin_ * static_cast<double>(part.size()));
    }
  } else {
    std::int64_t sum = 0;
    std::int64_t lowest = 0;
    std::int64_t highest = 0;
    for (std::size_t block = 0; block < blocks; ++block) {
      checkpoints_.push_back(static_cast<Sum>(sum));  // meaningful when range_bound() allows Sum
      const std::size_t at = block * kBlock;
      const auto part = samples.subspan(at, std::min(kBlock, samples.size() - at));
      if (part.empty()) break;
      const Extent span = extent(part);
      const auto size = static_cast<std::int64_t>(part.size());
      lowest = std::min(lowest, sum + size * std::min<std::int64_t>(0, span.least - origin_));
      highest = std::max(highest, sum + size * std::max<std::int64_t>(0, span.most - origin_));
      sum += span.sum - size * origin_;
    }
    range_bound_ = highest - lowest;
  }
}

template <class Sample, class Sum>
std::size_t PrefixSums<Sample, Sum>::fill(std::size_t block, Sum* out) const {
  const std::size_t at = block * kBlock;
  const std::size_t count = std::min(kBlock, samples_.size() - at);
  const Sample* x = samples_.data() + at;
  const Sum start = checkpoints_[block];
  if (count == 0) {
    *out = start;
    return 1;
  }
  if constexpr (std::is_same_v<Sum, double>) {
    kernels().prefix_double(x, origin_, start, out, count);
  } else if constexpr (std::is_same_v<Sum, std::int64_t>) {
    Sum sum = start;
    for (std::size_t i = 0; i < count; ++i) {
      out[i] = sum;
      sum += std::int64_t{x[i]} - origin_;
    }
  } else if constexpr (std::is_same_v<Sample, std::int16_t>) {
    kernels().prefix_int16(x, origin_, start, out, count);
  } else {
    kernels().prefix_int32(x, origin_, start, out, count);
  }
  if (count == kBlock) return kBlock;
  out[count] = static_cast<Sum>(out[count - 1] + (x[count - 1] - origin_));
  return count + 1;
}

void add_squares(const double* a, const double* b, const double* c, std::size_t n, double& total) {
  total += kernels().squares_double(a, b, c, n);
}

void add_squares(const std::int32_t* a, const std::int32_t* b, const std::int32_t* c, std::size_t n,
                 Total128& total) {
  total += kernels().squares_int(a, b, c, n);
}

void add_squares(const std::int64_t* a, const std::int64_t* b, const std::int64_t* c, std::size_t n,
                 Total128& total) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t w = (a[i] - b[i]) + (c[i] - b[i]);
    const auto size = static_cast<std::uint64_t>(w < 0 ? -w : w);
    total += static_cast<Total128>(size) * size;
  }
}

template class PrefixSums<double, double>;
template class PrefixSums<std::int16_t, std::int32_t>;
template class PrefixSums<std::int32_t, std::int32_t>;
template class PrefixSums<std::int16_t, std::int64_t>;
template class PrefixSums<std::int32_t, std::int64_t>;

}  // namespace imunoise
