#pragma once

// How much room a recording takes, and how much there is.

#include <cstdint>
#include <vector>

#include "recording/store/stream/stream.h"

namespace imunoise::acquire {

/// At most so many bytes a second become of a device's samples: as they stand in the journal,
/// before chunks are made smaller. Streams without a nominal rate are left out.
double bytes_per_second(const v1::RecordedDevice& device);

/// What is to be recorded, and what may not be used up.
struct DiskPlan {
  std::vector<v1::RecordedDevice> devices;
  double seconds = 0.0;  ///< Of all replicates that are still to come together.
  std::uint64_t reserve_bytes = 0;
};

/// Error: `free` less the reserve is not enough; says how much is needed, and when the disk would
/// be full.
Result<void> check_room(const DiskPlan& plan, std::uint64_t free);

}  // namespace imunoise::acquire
