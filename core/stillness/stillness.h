#pragma once

// Whether a sensor lies still: a knock widens the scatter within a second, moving it shifts the
// mean from one second to the next.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/support/units.h"

namespace imunoise {

/// One channel, a block of samples after the other. A block's size is how far it is from the blocks
/// before, in their robust standard deviations (median absolute deviation): the larger of the step
/// of its mean and the growth of its logarithmic variance. Steps rather than means: a random walk
/// has steps like any other noise.
class ChannelWatch {
 public:
  /// `quantum` is the step between neighbouring numbers, 0 where there is none.
  ChannelWatch(std::size_t block_samples, double quantum);

  void take(double number);
  /// After a block's samples: its size, 0 while too few blocks have been seen.
  double size() const;
  /// Ends the block; it joins those that later ones are compared with if it was still.
  void end_block(bool still);
  /// After a gap: the samples of this block are dropped, and the next step has nothing to go by.
  void restart();
  /// What was disturbed for long is how things are now.
  void forget();

 private:
  double mean() const;
  double log_variance() const;

  double block_;  // samples
  double quantum_;
  double origin_ = 0.0;  // of the sums, near the numbers
  std::size_t count_ = 0;
  double sum_ = 0.0;
  double squares_ = 0.0;
  std::optional<double> before_;  // mean of the last block
  std::deque<double> steps_;      // magnitudes
  std::deque<double> log_variances_;
};

/// The sensor was disturbed from the beginning of a block to the end of another.
struct Disturbance {
  std::int64_t begin = 0;    ///< as the caller counts time
  std::int64_t end = 0;      ///< of the last row
  double size = 0.0;         ///< the largest of a block, in robust standard deviations
  std::size_t channel = 0;   ///< that showed it
  std::size_t channels = 0;  ///< that were disturbed at the same time, at most
};

/// Channels that share their rows, watched block by block. Not thread-safe.
class Stillness {
 public:
  /// `quanta`: the step between neighbouring numbers of each channel, 0 where there is none.
  Stillness(Hertz rate, const std::vector<double>& quanta);

  /// A number of the row at hand.
  void take(std::size_t channel, double number) { channels_[channel].take(number); }
  void end_row(std::int64_t time);
  /// Rows are missing before the next one.
  void lost();
  /// In order of time; at most 1000.
  const std::vector<Disturbance>& found() const { return found_; }
  bool empty() const { return channels_.empty(); }

 private:
  void end_block(std::int64_t time);

  std::size_t block_samples_;
  std::vector<ChannelWatch> channels_;
  std::vector<Disturbance> found_;
  std::size_t filled_ = 0;
  std::int64_t begin_ = 0;
  std::size_t disturbed_ = 0;  // blocks in a row
  std::size_t still_ = 0;      // blocks since the last event
  bool open_ = false;          // the last event may go on
};

}  // namespace imunoise
