#pragma once

// Which streams can stand beside one another.

#include <cstdint>
#include <string>
#include <vector>

#include "recording/store/reading/device_streams.h"
#include "recording/store/timeline/common_grid.h"

namespace imunoise::recording {

/// A stream that is joined.
struct Joining {
  const DeviceStream* stream = nullptr;
  std::size_t averaged = 1;
};

/// A stream that is not, and why.
struct Staying {
  const DeviceStream* stream = nullptr;
  std::string reason;
};

/// Streams of rates with whole ratios. All borrow the streams.
struct WhoJoins {
  Hertz rate;                   ///< Common, nominal.
  std::vector<Joining> joined;  ///< In the order given.
  std::vector<Staying> left_out;
};

/// By the rules of import_across(): one for each rate that several devices go with, and at least
/// one. The first has most devices, and reports the devices left out.
std::vector<WhoJoins> who_joins(const std::vector<DeviceStream>& streams);

/// What common_grid() needs of a replicate; empty where one of them has no samples.
std::vector<GridStream> in_replicate(const std::vector<Joining>& joined, std::uint32_t replicate);

/// How much faster than nominal a stream samples, by the host's clock: 1e-6, mean of its samples.
/// Precondition: it has timelines.
double clock_ppm(const DeviceStream& stream);

/// How long streams run together, in all replicates: s. Of one: how long it was recorded.
double seconds_of(const std::vector<Joining>& joined);

/// How many devices they are of.
std::size_t devices_of(const std::vector<Joining>& joined);

}  // namespace imunoise::recording
