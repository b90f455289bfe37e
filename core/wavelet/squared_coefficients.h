#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "core/support/parallel.h"
#include "core/support/progress.h"
#include "core/wavelet/prefix_sums.h"
#include "core/wavelet/scales.h"

namespace imunoise {

/// The last blocks of prefix sums S around a moving point, contiguous in memory: S_{t-lag} for t in
/// the current block is at(lag). A cursor that follows the current block at a fixed distance is the
/// same thing with `delay` > 0: it produces its own blocks again rather than keeping the way
/// between.
template <class Prefix>
class PrefixWindow {
 public:
  using Sum = typename Prefix::SumType;

  /// Holds lags from `delay` to `delay + reach`.
  PrefixWindow(const Prefix& prefix, std::size_t delay, std::size_t reach)
      : prefix_(&prefix),
        delay_blocks_(delay / kBlock),
        history_((reach + delay % kBlock + kBlock - 1) / kBlock),
        buffer_((history_ + std::max<std::size_t>(1, history_ / 2) + 1) * kBlock) {}

  /// Moves on to a block; blocks must come in order, though they may start anywhere.
  void advance(std::size_t block) {
    if (block < delay_blocks_) return;  // the lagged block lies before the signal
    const std::size_t wanted = block - delay_blocks_;
    if (!started_) {
      next_ = wanted > history_ ? wanted - history_ : 0;
      first_ = next_;
      started_ = true;
    }
    for (; next_ <= wanted; ++next_) {
      if ((next_ - first_ + 1) * kBlock > buffer_.size()) {
        const std::size_t keep = history_ * kBlock;
        std::memmove(buffer_.data(), buffer_.data() + (next_ - first_) * kBlock - keep,
                     keep * sizeof(Sum));
        first_ = next_ - history_;
      }
      prefix_->fill(next_, buffer_.data() + (next_ - first_) * kBlock);
    }
  }

  /// Where S_t is, for t within the window after advance().
  const Sum* at(std::size_t t) const { return buffer_.data() + (t - first_ * kBlock); }

 private:
  const Prefix* prefix_;
  std::size_t delay_blocks_;
  std::size_t history_;  // blocks kept behind the current one
  std::vector<Sum> buffer_;
  std::size_t first_ = 0;  // block at the start of the buffer
  std::size_t next_ = 0;   // block to fill next
  bool started_ = false;
};

/// Σ_t (S_t - 2 S_{t-m} + S_{t-2m})² for each scale m, over t = 2m .. T: M·4m² times the wavelet
/// variance. One pass in blocks of kBlock samples with all scales in each; near lags come from a
/// window that fits the cache, far lags from cursors of their own. Segments of fixed length run in
/// parallel and are added in order. Memory: well under a tenth of the signal's for long signals.
template <class Prefix>
std::vector<typename Prefix::Total> squared_coefficients(const Prefix& prefix, const Scales& scales,
                                                         const Progress& progress) {
  using Total = typename Prefix::Total;
  constexpr std::size_t kNearReach = 512 * kBlock;
  constexpr std::size_t kSegmentBlocks = 1024;
  const std::size_t last = prefix.samples();  // S_0 .. S_last
  const std::size_t blocks = last / kBlock + 1;
  const std::size_t segments = (blocks + kSegmentBlocks - 1) / kSegmentBlocks;

  std::vector<std::size_t> far_lags;
  std::size_t near_reach = 0;
  for (const std::int64_t m : scales) {
    near_reach = std::min(kNearReach, std::max(near_reach, static_cast<std::size_t>(2 * m)));
    for (const std::size_t lag : {static_cast<std::size_t>(m), static_cast<std::size_t>(2 * m)}) {
      if (lag > kNearReach) far_lags.push_back(lag);
    }
  }
  std::sort(far_lags.begin(), far_lags.end());
  far_lags.erase(std::unique(far_lags.begin(), far_lags.end()), far_lags.end());

  std::vector<std::vector<Total>> parts(segments, std::vector<Total>(scales.size()));
  for_each_index(segments, [&](std::size_t segment) {
    PrefixWindow<Prefix> near(prefix, 0, near_reach);
    std::vector<PrefixWindow<Prefix>> far;
    far.reserve(far_lags.size());
    for (const std::size_t lag : far_lags) far.emplace_back(prefix, lag, 0);
    const auto lagged = [&](std::size_t t, std::size_t lag) {
      if (lag <= kNearReach) return near.at(t - lag);
      const auto found = std::lower_bound(far_lags.begin(), far_lags.end(), lag);
      return far[static_cast<std::size_t>(found - far_lags.begin())].at(t - lag);
    };
    const std::size_t end_block = std::min(blocks, (segment + 1) * kSegmentBlocks);
    for (std::size_t block = segment * kSegmentBlocks; block < end_block; ++block) {
      if (progress.stopped()) return;
      near.advance(block);
      for (auto& window : far) window.advance(block);
      const std::size_t end = std::min(last + 1, (block + 1) * kBlock);
      for (std::size_t i = 0; i < scales.size(); ++i) {
        const auto m = static_cast<std::size_t>(scales[i]);
        const std::size_t begin = std::max(block * kBlock, 2 * m);
        if (begin >= end) continue;
        add_squares(near.at(begin), lagged(begin, m), lagged(begin, 2 * m), end - begin,
                    parts[segment][i]);
      }
    }
    progress.report(static_cast<double>(segment + 1) / static_cast<double>(segments));
  });

  std::vector<Total> out(scales.size());
  for (const auto& part : parts) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += part[i];
  }
  return out;
}

}  // namespace imunoise
