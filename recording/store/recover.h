#pragma once

// After a crash: everything that was acknowledged becomes chunks, exactly once; what is damaged is
// set aside, never deleted.

#include <string>
#include <vector>

#include "recording/store/journal.h"
#include "recording/store/manifest.h"

namespace imunoise::recording {

/// One device's folder after its recovery.
struct RecoveredDevice {
  std::optional<v1::RecordedDevice> device;  ///< Nothing when no chunk is left.
  std::vector<v1::ChunkEntry> chunks;
  std::vector<std::string> repaired;  ///< What was found and done, for people.
  JournalPlace next;                  ///< Where its journal would go on.
};

/// Recovers one folder; `known` is the manifest, empty when it was lost. May be repeated after an
/// error or a crash at any point. Error: the disk's. Nobody else may be writing: hold the lock
/// (FileSystem::lock) of the recording's folder.
Result<RecoveredDevice> recover_device(FileSystem& files, const DeviceFolder& where,
                                       const v1::Manifest& known);

/// What a recovery of the whole recording did.
struct RecoveredRecording {
  v1::Manifest manifest;
  std::vector<std::string> repaired;
};

/// Recovers every folder and writes the manifest. Hold the lock. Error: the disk's, a manifest of
/// another version of the format.
Result<RecoveredRecording> recover_recording(FileSystem& files, const std::filesystem::path& root);

}  // namespace imunoise::recording
