#pragma once

// The recordings of a campaign on disk: a folder each, named by its start, in the campaign's
// folder.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/acquire/next_step.h"
#include "recording/store/file_system.h"

namespace imunoise::acquire {

/// "2026-03-01T060000Z"
std::string recording_name(Time started);
/// The inverse, to the second; nothing for another name.
std::optional<Time> start_of(std::string_view name);

struct FoundRecording {
  std::filesystem::path folder;
  RecordingState state;
};

/// The newest recording of the campaign in its folder; of a manifest that is missing only the
/// folders of replicates are known. Folders of other campaigns are passed over. Error: the disk's;
/// a damaged manifest of the newest.
Result<std::optional<FoundRecording>> newest_recording(const recording::FileSystem& files,
                                                       const v1::Campaign& campaign);

/// Deletes recordings that the campaign's retention does not keep: closed ones of this campaign,
/// never the newest. Returns their folders. Error: one cannot be deleted.
Result<std::vector<std::filesystem::path>> tidy_recordings(const recording::FileSystem& files,
                                                           const v1::Campaign& campaign, Time now);

}  // namespace imunoise::acquire
