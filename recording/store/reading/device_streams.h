#pragma once

// The streams of several devices as they were recorded, before their clocks are brought together.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/support/progress.h"
#include "recording/store/reading/places.h"
#include "recording/store/timeline/timeline.h"

namespace imunoise::recording {

/// A stream in one replicate.
struct StreamSamples {
  std::vector<Timeline> timelines;
  std::vector<std::shared_ptr<const Samples>> channels;  ///< Of all its rows.
};

struct DeviceStream {
  std::string device;
  std::string stream;
  Hertz rate;                     ///< Nominal.
  std::vector<Channel> channels;  ///< Those wanted, without samples.
  std::map<std::uint32_t, StreamSamples> replicates;
  std::string defect;  ///< Why it cannot be read; empty when it can.
};

/// Reads the wanted channels, stream by stream in the order in which they are first wanted. A
/// device that is not sound has a defect and no samples. Error: the disk's, an unknown unit, a
/// stop.
Result<std::vector<DeviceStream>> read_streams(const FileSystem& files,
                                               const std::filesystem::path& root,
                                               const v1::Manifest& manifest,
                                               const std::vector<Wanted>& wanted,
                                               const Progress& progress);

}  // namespace imunoise::recording
