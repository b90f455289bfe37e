#pragma once

// The two manifests that change while a replicate is recorded: the recording's and its own.

#include <string>
#include <utility>
#include <vector>

#include "recording/store/recorder/recorder.h"
#include "recording/store/recovery/recover.h"

namespace imunoise::recording {

/// Not thread-safe. No other process writes them: the folder is locked.
class RecorderManifests {
 public:
  /// Recovers what is there and adds the plan's devices. Only what was recovered is written yet.
  /// Error: as Recorder::start().
  static Result<RecorderManifests> open(FileSystem& files, const std::filesystem::path& folder,
                                        const RecordingPlan& plan);

  /// What was found and done, for people.
  const std::vector<std::string>& repaired() const { return repaired_; }

  /// Writes both: the recording is not closed, its replicate is open.
  Result<void> begin(FileSystem& files);
  /// Error: the recording has a device of this name and another serial number.
  Result<void> check(const v1::RecordedDevice& device) const;
  /// Adds a device and writes both. Error: the disk's; nothing is added.
  Result<void> add(FileSystem& files, const v1::RecordedDevice& device);
  /// Writes both a last time. `settled`: every row is in a listed chunk.
  Result<void> end(FileSystem& files, bool closed, bool settled);

  std::uint32_t replicate() const { return replicate_; }
  /// Of the replicate: its chunks are added, and its note is set, before end().
  v1::ReplicateManifest& own() { return own_; }
  const v1::ReplicateManifest& own() const { return own_; }
  void set_note(v1::ReplicateNote note);

 private:
  RecorderManifests(std::filesystem::path folder, std::uint32_t replicate,
                    RecoveredRecording recovered)
      : folder_(std::move(folder)),
        replicate_(replicate),
        recording_(std::move(recovered.manifest)),
        repaired_(std::move(recovered.repaired)) {}

  std::filesystem::path folder_;
  std::uint32_t replicate_;
  v1::RecordingManifest recording_;
  v1::ReplicateManifest own_;
  std::vector<std::string> repaired_;
};

}  // namespace imunoise::recording
