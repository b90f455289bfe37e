#pragma once

// After a crash: everything that was acknowledged becomes chunks, exactly once; what is damaged is
// set aside, never deleted. What cannot be read is not damaged: it is an error, and may be read the
// next time. What is away, or of another version, is not lost: it stays promised.

#include <string>
#include <vector>

#include "recording/store/journal/journal.h"
#include "recording/store/manifest/manifest.h"

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
  std::uint64_t unproven = 0;         ///< Those of them in chunks that are away or unusable.
  bool settled = true;                ///< Nothing is away, nothing is unusable.
  std::vector<std::string> repaired;  ///< What was found and done, for people.
  JournalPlace next;                  ///< Where its journal would go on.
};

/// Recovers one folder; `known` is the manifest, empty when it was lost. May be repeated after an
/// error or a crash at any point. Error: the disk's. No other writer may be active: hold the lock
/// (FileSystem::lock) of the recording's folder.
Result<RecoveredDevice> recover_device(FileSystem& files, const DeviceFolder& where,
                                       const v1::Manifest& known, Recovery how);

/// One replicate after its recovery.
struct RecoveredReplicate {
  v1::ReplicateManifest manifest;
  std::vector<v1::RecordedDevice> devices;  ///< Of its chunks.
  bool settled = true;                      ///< As a device's.
  std::vector<std::string> repaired;
};

/// Recovers the folders of a replicate, and writes nothing but chunks. `unfinished` says why it may
/// have stayed open, where that is known. A replicate is complete no more once samples are proven
/// to be lost. Otherwise as recover_device().
Result<RecoveredReplicate> recover_replicate(FileSystem& files, const std::filesystem::path& root,
                                             std::uint32_t replicate,
                                             const v1::RecordingManifest& recording,
                                             const v1::ReplicateManifest& known, Recovery how,
                                             const std::string& unfinished);

/// What a recovery of the whole recording found and did.
struct RecoveredRecording {
  v1::RecordingManifest manifest;
  bool changed = false;  ///< manifest.json is not there or has something else.
  std::vector<std::string> repaired;
};

/// What is known before a recovery.
struct Circumstances {
  std::string unfinished;  ///< Why a replicate may have stayed open; empty: unknown.
  std::uint32_t next = 0;  ///< The replicate that will be recorded; 0: none.
};

/// Recovers replicates and writes their manifests; manifest.json is left to the caller. Its time
/// does not depend on the number of settled replicates if the recording was closed and `next`
/// follows them: it does not even list the folder. Hold the lock. Error: the disk's, a manifest of
/// another version.
Result<RecoveredRecording> recover_replicates(FileSystem& files, const std::filesystem::path& root,
                                              Recovery how, const Circumstances& known = {});

/// The same, and writes manifest.json.
Result<RecoveredRecording> recover_recording(FileSystem& files, const std::filesystem::path& root,
                                             Recovery how = Recovery::kEverything);

}  // namespace imunoise::recording
