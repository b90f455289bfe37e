#pragma once

// Recorded samples as a device.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/plugin.h"
#include "drivers/replay/pace.h"
#include "recording/import/table/channel.h"

namespace imunoise::replay {

/// One stream, "samples": the replicates one after another, numbers as they were stored, scaled to
/// SI. The counter is the sample's index in its replicate, the device time that index over the
/// rate; host times follow the recording's own time line from the start of the replay, whatever the
/// speed. The first sample of each replicate is marked IMUNOISE_SAMPLE_AFTER_RESTART.
class ReplayDevice : public plugin::Device {
 public:
  /// Replicates as import_files() returns them: the same channels and rate in each.
  ReplayDevice(std::vector<recording::Replicate> replicates, Pace pace, const plugin::Host& host);

  drivers::DeviceInfo describe() override;
  void read(plugin::Samples& samples, const plugin::Wait& wait) override;

 private:
  std::size_t due(const plugin::Wait& wait) const;
  std::int64_t time_ns(std::size_t index) const;
  plugin::Wait::Clock::time_point moment(std::size_t samples) const;

  std::vector<recording::Replicate> replicates_;
  Timeline timeline_;
  double rate_hz_;
  std::size_t replicate_ = 0;  // that is being delivered
  std::size_t next_ = 0;       // its next sample
  std::size_t sent_ = 0;       // samples delivered of all replicates
};

}  // namespace imunoise::replay
