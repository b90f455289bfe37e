#pragma once

// When the samples of a stream were taken, by the host's clock.

#include <cstdint>
#include <vector>

#include "recording/store/timeline/gaps.h"

namespace imunoise::recording {

/// A stretch of consecutive samples: its sample i was taken at first_ns + i · period_ns.
struct Timeline {
  Part part;                  ///< Rows of the stream.
  std::int64_t first_ns = 0;  ///< ns since 1970-01-01 UTC, less the chance delays.
  double period_ns = 0.0;     ///< By the host's clock; the nominal one is another.

  double time_ns(double sample, std::int64_t since_ns) const {
    return static_cast<double>(first_ns - since_ns) + sample * period_ns;
  }
};

/// The stretches between the stream's gaps, in order, each with the straight line that DeviceClock
/// draws through when its samples came; a stretch that is too short to be compared (ten seconds) is
/// left out. The delay that all samples of a stream have in common is not known and stays in
/// first_ns.
std::vector<Timeline> timelines(const v1::RecordedStream& stream, const Rows& rows);

}  // namespace imunoise::recording
