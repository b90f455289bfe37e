#pragma once

// What imunoise recorded, as the device that it was recorded from.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "drivers/plugin.h"
#include "drivers/replay/pace.h"
#include "recording/store/reading/device_recording.h"

namespace imunoise::replay {

/// Which of a recording's devices and replicates.
struct RecordingChoice {
  std::string folder;
  std::optional<std::string> device = {};       ///< Unset: the only one.
  std::optional<std::uint32_t> replicate = {};  ///< Unset: the first.
};

/// Reads it. Errors: no recording, no such device or replicate (with those there are), several
/// devices and none chosen, chunks that are not intact (imunoise verify says more).
Result<recording::DeviceRecording> read_recording(const RecordingChoice& choice);

/// All streams with their numbers, counters and flags as they were stored; streams take turns as
/// their samples did. Host times keep their distances and begin with the replay. Where samples are
/// missing the next one is marked IMUNOISE_SAMPLE_AFTER_GAP.
class RecordingDevice final : public plugin::Device {
 public:
  /// Precondition: as read_recording() returns it.
  RecordingDevice(recording::DeviceRecording recorded, Pace pace, const plugin::Host& host);

  drivers::DeviceInfo describe() override;
  void read(plugin::Samples& samples, const plugin::Wait& wait) override;

 private:
  std::optional<std::size_t> next_stream() const;
  void deliver(std::size_t stream, std::int64_t until_ns, plugin::Samples& samples);

  recording::DeviceRecording recorded_;
  Timeline timeline_;
  std::int64_t begin_ns_ = 0;      // host time of the first sample, as recorded
  std::vector<std::size_t> next_;  // by stream: row
};

}  // namespace imunoise::replay
