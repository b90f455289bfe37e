#pragma once

// What becomes of a recording once its replicates are complete.

#include <filesystem>
#include <mutex>
#include <string>

#include "core/support/progress.h"
#include "core/support/result.h"
#include "imunoise/v1/campaign.pb.h"
#include "recording/store/disk/disk_calls.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::app {

/// Calibrates and publishes. Both return what is to be told, or nothing, and do nothing for a
/// recording that they have seen as it is. Thread-safe; one calibration at a time.
class Aftercare {
 public:
  /// `imunoise` is the program that calibrates, in a process of its own: whatever it meets with,
  /// recording goes on.
  /// `calls` tell what hangs: both functions are among them while they work.
  Aftercare(recording::FileSystem& files, recording::DiskCalls& calls,
            std::filesystem::path imunoise)
      : files_(files), calls_(calls), imunoise_(std::move(imunoise)) {}

  /// Leaves calibration.json in the recording, as the campaign's [calibration] says. Error: what
  /// `imunoise calibrate` says, or the caller stopped it.
  Result<std::string> calibrate(const v1::Campaign& campaign,
                                const std::filesystem::path& recording, const Progress& progress);
  /// Brings the catalogue in the campaign's folder up to date, and asks whether a device of the
  /// recording drifts: that is told. Error: the catalogue's.
  Result<std::string> publish(const v1::Campaign& campaign, const std::filesystem::path& recording,
                              const Progress& progress);

 private:
  recording::FileSystem& files_;
  recording::DiskCalls& calls_;
  std::filesystem::path imunoise_;
  std::mutex calibrating_;
  std::mutex publishing_;
};

}  // namespace imunoise::app
