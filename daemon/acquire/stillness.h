#pragma once

// Watches whether the sensors of a device lie still while they are recorded.

#include <cstddef>
#include <vector>

#include "core/stillness/stillness.h"
#include "recording/store/stream/stream.h"

namespace imunoise::acquire {

/// The angular rates and accelerations of one device. Not thread-safe.
class StillnessWatch {
 public:
  /// Streams without a nominal rate or without such channels are not watched.
  explicit StillnessWatch(const v1::RecordedDevice& device);

  /// Samples as they are recorded: check_block() accepted them.
  void take(const recording::Block& block);
  /// What was seen until now, in order of time for each stream.
  std::vector<v1::Disturbance> disturbances() const;

 private:
  struct Stream {
    std::vector<std::size_t> channels;  // indices in the stream
    Stillness watch;
  };

  v1::RecordedDevice device_;
  std::vector<Stream> streams_;
};

/// Those of several devices: what overlaps is one, told by the device that saw it first. At most
/// 1000.
std::vector<v1::Disturbance> merge_disturbances(std::vector<v1::Disturbance> all);

}  // namespace imunoise::acquire
