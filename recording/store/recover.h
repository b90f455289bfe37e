#pragma once

// After a crash: everything that was acknowledged becomes chunks, exactly once; what is damaged is
// set aside, never deleted. What cannot be read is not damaged: it is an error, and may be read the
// next time.

#include <string>
#include <vector>

#include "recording/store/journal.h"
#include "recording/store/manifest.h"

namespace imunoise::recording {

/// How far a recovery goes.
enum class Recovery {
  kUnsettled,   ///< Replicates that were not closed; what is missing stays promised.
  kEverything,  ///< All; what is missing is put on record and accepted (`imunoise verify
                ///< --repair`).
};

/// One device's folder after its recovery.
struct RecoveredDevice {
  std::optional<v1::RecordedDevice> device;  ///< Nothing when no chunk is left.
  std::vector<v1::ChunkEntry> chunks;        ///< As the manifest should list them.
  std::vector<v1::DamagedFile> damaged;
  std::vector<std::uint64_t> rows;    ///< In chunks, of each of the device's streams.
  std::uint64_t promised = 0;         ///< Rows in the chunks that the manifest listed.
  bool settled = true;                ///< Nothing is missing, nothing is unusable.
  std::vector<std::string> repaired;  ///< What was found and done, for people.
  JournalPlace next;                  ///< Where its journal would go on.
};

/// Recovers one folder; `known` is the manifest, empty when it was lost. May be repeated after an
/// error or a crash at any point. Error: the disk's. Nobody else may be writing: hold the lock
/// (FileSystem::lock) of the recording's folder.
Result<RecoveredDevice> recover_device(FileSystem& files, const DeviceFolder& where,
                                       const v1::Manifest& known, Recovery how);

/// What a recovery of the whole recording did.
struct RecoveredRecording {
  v1::Manifest manifest;
  std::vector<std::string> repaired;
};

/// Recovers folders and writes the manifest. A replicate that lacks samples is complete no more.
/// Hold the lock. Error: the disk's, a manifest of another version of the format.
Result<RecoveredRecording> recover_recording(FileSystem& files, const std::filesystem::path& root,
                                             Recovery how = Recovery::kEverything);

}  // namespace imunoise::recording
