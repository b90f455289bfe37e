#pragma once

// The latest samples of one stream while it is recorded, for a screen.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "imunoise/v1/recording.pb.h"
#include "imunoise/v1/samples.pb.h"
#include "recording/store/stream/channel_units.h"
#include "recording/store/stream/stream.h"

namespace imunoise::live {

/// Rings of ranges of 1, 4, 16, ... 4096 samples: the least and the greatest of each. A range
/// without a finite number repeats the one before it. Memory is the same from the first sample on:
/// 1024 ranges of each ring, about 60 kB a channel. Not thread-safe.
class SampleRings {
 public:
  explicit SampleRings(const v1::RecordedStream& stream);

  /// Rows as they are recorded: check_block() accepted them.
  void take(const recording::Rows& rows);

  /// The complete ranges of `samples_each` samples (0: 1) from number `from` on, as far as they are
  /// kept, of some channels (none: all). Without replicate and length. Error: a size that no ring
  /// has, a channel that the stream has not.
  Result<v1::SampleRanges> ranges(std::uint32_t samples_each, std::uint64_t from,
                                  const std::vector<std::string>& channels) const;

  /// The last minute of a channel at `rate_hz`, as 15 to 60 ranges: a picture without axes.
  v1::RangeChannel last_minute(std::size_t channel, double rate_hz) const;

 private:
  struct Channel {
    std::string name;
    recording::ChannelUnits units;
  };
  struct Extent {
    float lower = 0.0F;
    float upper = 0.0F;
  };
  struct Ring {
    std::uint32_t samples_each = 1;
    std::uint64_t complete = 0;       // ranges so far
    std::uint32_t held = 0;           // samples in the range under way
    std::vector<std::int64_t> times;  // ns, of each range's first sample
    std::vector<bool> gaps;
    std::vector<Extent> extents;  // of all channels, range after range; the last is under way
  };
  void push(Ring& ring, std::int64_t time, bool gap, const std::vector<Extent>& values) const;

  std::vector<Channel> channels_;
  std::vector<Ring> rings_;
  std::vector<Extent> newest_;  // of all channels
  std::optional<std::int64_t> begin_ns_;
};

}  // namespace imunoise::live
