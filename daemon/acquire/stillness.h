#pragma once

// Watches whether a bench lies still: a knock widens the scatter within a second, moving the
// bench shifts the mean from one second to the next.

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "recording/store/stream.h"

namespace imunoise::acquire {

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

/// The angular rates and accelerations of one device. Not thread-safe.
class StillnessWatch {
 public:
  /// Streams without a nominal rate or without such channels are not watched.
  explicit StillnessWatch(const v1::RecordedDevice& device);

  /// Samples as they are recorded: check_block() accepted them.
  void take(const recording::Block& block);
  /// What was seen until now, in order of time for each stream.
  const std::vector<v1::Disturbance>& disturbances() const { return found_; }

 private:
  struct Watched {
    std::size_t channel = 0;  // index in the stream
    ChannelWatch watch;
  };
  struct Stream {
    std::size_t block_samples = 0;
    std::vector<Watched> channels;
    std::size_t filled = 0;
    std::int64_t begin_ns = 0;
    std::size_t disturbed = 0;         // blocks in a row
    std::optional<std::size_t> event;  // in found_: the one that may go on
    std::size_t still = 0;             // blocks since it
  };
  void end_block(std::size_t stream, std::int64_t end_ns);

  v1::RecordedDevice device_;
  std::vector<Stream> streams_;
  std::vector<v1::Disturbance> found_;
};

/// Those of several devices: what overlaps is one, told by the device that saw it first. At most
/// 1000.
std::vector<v1::Disturbance> merge_disturbances(std::vector<v1::Disturbance> all);

}  // namespace imunoise::acquire
