#pragma once

// The recordings of a campaign on disk: a folder each, named by its start, in the campaign's
// folder.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/acquire/campaign/next_step.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::acquire {

/// "2026-03-01T060000Z"
std::string recording_name(Time started);
/// The inverse, to the second; nothing for another name.
std::optional<Time> start_of(std::string_view name);

struct FoundRecording {
  std::filesystem::path folder;
  RecordingState state;  ///< It started then by the clock as it is set now.
};

/// The newest recording of the campaign in its folder, by the clock as it is set now; one that
/// seems to begin after now, and was not recorded since the machine started, was recorded under a
/// wrong clock and is passed over. `known`: where this process recorded last; may be empty. Of a
/// manifest that is missing only the folders of replicates are known. Folders of other campaigns
/// are passed over. Error: the disk's; a damaged manifest of the newest.
Result<std::optional<FoundRecording>> newest_recording(const recording::FileSystem& files,
                                                       const v1::Campaign& campaign,
                                                       const Clock& clock,
                                                       const std::filesystem::path& known = {});

struct Tidied {
  std::vector<std::filesystem::path> removed;
  std::size_t doubtful = 0;  ///< Kept although they look too old: the clock is not to be trusted.
};

/// Deletes recordings that the campaign's retention does not keep: closed ones of this campaign,
/// never the newest. None is too old unless the clock is synchronised now, and was when it was
/// recorded; what was recorded since the machine started has to be so old by the time since then,
/// too. Error: one cannot be deleted.
Result<Tidied> tidy_recordings(recording::FileSystem& files, const v1::Campaign& campaign,
                               const Clock& clock);

}  // namespace imunoise::acquire
