#include "core/wavelet/streaming_variance.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace imunoise {

template <class Sample>
StreamingVariance<Sample>::StreamingVariance(Scales scales, Hertz rate, Quantity quantity,
                                             double scale)
    : scales_(std::move(scales)),
      rate_(rate),
      quantity_(quantity),
      scale_(scale),
      reach_(scales_.empty() ? 0 : static_cast<std::size_t>(2 * scales_.largest())),
      window_{Sum{}},
      totals_(scales_.size()) {}

template <class Sample>
void StreamingVariance<Sample>::push(std::span<const Sample> samples) {
  if (samples_ == 0 && !samples.empty()) origin_ = samples.front();
  while (!samples.empty()) {
    const std::size_t unused = first_ + window_.size() - used_;
    const auto piece =
        samples.first(std::min(samples.size(), kBlock - std::min(unused, kBlock - 1)));
    for (const Sample x : piece) {
      window_.push_back(window_.back() + (static_cast<Sum>(x) - static_cast<Sum>(origin_)));
    }
    samples_ += piece.size();
    samples = samples.subspan(piece.size());
    if (first_ + window_.size() - used_ >= kBlock) {
      add_new_sums(totals_);
      used_ = first_ + window_.size();
      make_room();
    }
  }
}

// Adds the coefficients that end at the sums not yet used (at most kBlock of them).
template <class Sample>
void StreamingVariance<Sample>::add_new_sums(std::vector<Total>& totals) const {
  const std::size_t end = first_ + window_.size();
  for (std::size_t i = 0; i < scales_.size(); ++i) {
    const auto m = static_cast<std::size_t>(scales_[i]);
    const std::size_t begin = std::max(used_, 2 * m);
    if (begin >= end) continue;
    const Sum* now = window_.data() + (begin - first_);
    add_squares(now, now - m, now - 2 * m, end - begin, totals[i]);
  }
}

// Drops sums that no later coefficient needs; brings the rest back near zero, which wavelets
// ignore.
template <class Sample>
void StreamingVariance<Sample>::make_room() {
  const std::size_t keep = reach_ + 1;
  if (window_.size() < 2 * keep + 4 * kBlock) return;
  const std::size_t drop = window_.size() - keep;
  const Sum base = window_[drop];
  window_.erase(window_.begin(), window_.begin() + static_cast<std::ptrdiff_t>(drop));
  for (Sum& sum : window_) sum -= base;
  first_ += drop;
}

template <class Sample>
WaveletVariance StreamingVariance<Sample>::estimate(double confidence) const {
  std::vector<Total> totals = totals_;
  add_new_sums(totals);
  std::vector<bool> supported(scales_.size());
  for (std::size_t i = 0; i < scales_.size(); ++i) {
    supported[i] = static_cast<std::size_t>(2 * scales_[i]) <= samples_;
  }
  WaveletVariance out;
  out.scales = scales_.where(supported);
  out.confidence = confidence;
  out.samples = samples_;
  out.rate = rate_;
  out.quantity = quantity_;
  out.variance.resize(static_cast<Eigen::Index>(out.scales.size()));
  for (std::size_t i = 0; i < out.scales.size(); ++i) {  // supported scales come first
    const auto m = static_cast<double>(out.scales[i]);
    const double count = static_cast<double>(samples_) - 2.0 * m + 1.0;
    out.variance(static_cast<Eigen::Index>(i)) =
        scale_ * scale_ * static_cast<double>(totals[i]) / (count * 4.0 * m * m);
  }
  set_chi_square_interval(out);
  return out;
}

template class StreamingVariance<double>;
template class StreamingVariance<std::int16_t>;
template class StreamingVariance<std::int32_t>;

}  // namespace imunoise
