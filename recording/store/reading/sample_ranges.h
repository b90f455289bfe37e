#pragma once

// Samples of a stream as ranges for a screen: the least and the greatest of each stretch.

#include <cstdint>
#include <string>
#include <vector>

#include "imunoise/v1/samples.pb.h"
#include "recording/store/stream/channel_units.h"
#include "recording/store/stream/stream.h"

namespace imunoise::recording {

/// Makes ranges of rows that come in pieces. A range without a finite number repeats the one before
/// it.
class RangeBuilder {
 public:
  /// All channels of the stream. Precondition: samples_each > 0.
  RangeBuilder(const v1::RecordedStream& stream, std::uint32_t samples_each);

  /// Rows [begin, end) of a piece that follows the one before.
  void take(const Rows& rows, std::size_t begin, std::size_t end);
  /// With a last range that may hold fewer samples. Times count from `begin_ns`; without replicate,
  /// next and length.
  v1::SampleRanges finish(std::int64_t begin_ns) &&;

 private:
  std::vector<ChannelUnits> units_;
  v1::SampleRanges out_;
  std::vector<std::int64_t> times_;
  std::vector<float> newest_;
  std::uint32_t held_ = 0;
};

/// Ranges [begin, end) of `fine`, `together` of them as one, of some channels by their place.
v1::SampleRanges coarser(const v1::SampleRanges& fine, int begin, int end, int together,
                         const std::vector<int>& channels);

}  // namespace imunoise::recording
