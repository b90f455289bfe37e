#pragma once

// Runs a campaign: asks next_step() what comes next, does it, and asks again.

#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>

#include "core/support/progress.h"
#include "daemon/acquire/campaign/next_step.h"
#include "daemon/acquire/clock.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::acquire {

/// One replicate of a campaign that is to be recorded.
struct ReplicateTask {
  std::filesystem::path folder;          ///< Of the recording; made when missing.
  std::uint32_t replicate = 1;           ///< Its number on disk.
  std::uint32_t replicates_to_come = 0;  ///< After this one, in this recording.
  std::string unfinished = {};  ///< Why the one before was not closed, where that is known.
};

/// What records replicates.
class ReplicateRecorder {
 public:
  virtual ~ReplicateRecorder() = default;
  /// Records one, as the campaign says, and closes it; ends early when it is stopped. What became
  /// of it is in the manifest, and returned. Error: nothing was recorded, or the disk's.
  virtual Result<v1::ReplicateNote> record(const v1::Campaign& campaign, const ReplicateTask& task,
                                           const Progress& progress) = 0;
};

/// What is done with a recording whose replicates are complete; returns what is worth telling.
/// After a restart it may be called again for one that it has seen: it does nothing then. Stopped,
/// it returns soon.
using RecordingHook = std::function<Result<std::string>(const v1::Campaign& campaign,
                                                        const std::filesystem::path& recording,
                                                        const Progress& progress)>;

/// All that a campaign touches.
struct CampaignSurroundings {
  Clock& clock;
  recording::FileSystem& files;
  ReplicateRecorder& recorder;
  RecordingHook calibrate = {};  ///< Either may be empty.
  RecordingHook publish = {};
  /// Told at every step.
  std::function<void(const v1::CampaignStatus&)> tell = {};
  /// Asks for an end that costs no recorded sample: a replicate that is being recorded goes on to
  /// its own end, everything else ends at once.
  std::stop_token leave = {};
};

enum class RunMode {
  kScheduled,  ///< As the campaign's schedule says.
  kOnce,       ///< One recording: the unfinished one, or else a new one.
};

/// Runs until the campaign is finished or stopped. Nothing that goes wrong ends it: it is
/// told, and tried again after 5 s, then after twice as long each time, up to 5 min. A restart goes
/// on where the manifests say it was.
void run_campaign(const v1::Campaign& campaign, RunMode mode,
                  const CampaignSurroundings& surroundings, const std::stop_token& stop);

}  // namespace imunoise::acquire
