#pragma once

// Reads what a device recorded, across its chunks.

#include <string>
#include <vector>

#include "core/support/progress.h"
#include "recording/store/manifest/manifest.h"

namespace imunoise::recording {

/// Everything of one device in one replicate that is intact.
struct DeviceRecording {
  DeviceFolder where;
  v1::RecordedDevice device;
  std::vector<Rows>
      streams;  ///< As device.streams; kLostBefore where blocks or chunks are missing.
  std::vector<std::uint64_t> in_journal;  ///< Rows of each stream that are not in a chunk yet.
  std::size_t chunks = 0;                 ///< Intact ones.
  std::vector<std::string> broken;   ///< Files that were set aside, as the manifest names them.
  std::vector<std::string> defects;  ///< What is not intact; each with the way out.
};

/// Reads all chunks of a device; changes nothing. `manifest` is empty when there is none. What is
/// damaged is a defect, not an error. Error: the disk's; chunks that disagree about the device.
Result<DeviceRecording> read_device(const FileSystem& files, const DeviceFolder& where,
                                    const v1::Manifest& manifest);

}  // namespace imunoise::recording
