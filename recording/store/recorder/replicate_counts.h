#pragma once

// What a replicate's note says of its rows.

#include <vector>

#include "recording/store/recorder/recorder.h"

namespace imunoise::recording {

/// Rows that the disk did not take.
std::uint64_t not_written(const StreamCounts& counts);

/// What the disk did not take of one device, as an error with the disk's own. `state` is that after
/// the last write.
Result<void> check_written(const v1::RecordedDevice& device, const RecorderState& state,
                           std::size_t index);

/// The replicate ended early for this reason too.
void interrupt(v1::ReplicateNote& note, const Error& reason);

/// Writes the counts of all streams into the note. When rows were not written the replicate is
/// interrupted, for that reason too.
void settle_note(v1::ReplicateNote& note, const std::vector<v1::RecordedDevice>& devices,
                 const RecorderState& state);

}  // namespace imunoise::recording
