#pragma once

// The clocks of a device's streams, as it is read.

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/host/block.h"
#include "recording/store/timeline/device_clock.h"

namespace imunoise::acquire {

/// Takes the device's own time where a stream has one, else its sample counter over its nominal
/// rate; streams without either are not compared. Not thread-safe.
class StreamClocks {
 public:
  void take(const drivers::SampleBlock& block);
  /// Of the streams that were compared, in the name of this device.
  std::vector<v1::ClockComparison> comparisons(const std::string& device) const;

 private:
  struct One {
    std::string stream;
    bool from_counter = false;
    recording::DeviceClock clock;
    std::uint64_t counter = 0;  // of the last sample, and when it came
    std::int64_t host_ns = 0;
    std::uint64_t count = 0;  // samples since the clock began, lost ones too
    bool begun = false;
  };
  void take_counters(const drivers::SampleBlock& block, One& to);

  std::vector<One> streams_;  // by their index
};

}  // namespace imunoise::acquire
