#pragma once

// A recording as replicates, as import_files() gives them: what a model is fitted to.

#include "recording/import/import.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::recording {

/// Reads one stream of one device in all replicates. Each stretch without a gap is one replicate,
/// named "replicate-1", or "replicate-1#2" where gaps cut it; stretches of fewer than
/// kMinimumSamples are left out. Channels are named "gyro_x", or "imu0/imu/gyro_x" (device, stream)
/// where a recording has several streams. `options`: channels, rate, unit and split_into, as for
/// import_files(); int16 and int32 stay counts, other numbers become doubles. The rate is the
/// nominal one. With options.beside the device's other streams come too, at_times() of that stream,
/// less channels of unknown units.
///
/// Errors: a recording that is not sound (imunoise verify says why), a channel that it has not,
/// channels of several streams at once (the channels it has are listed), nothing long enough.
Result<std::vector<Replicate>> import_recording(const FileSystem& files,
                                                const std::filesystem::path& root,
                                                const ImportOptions& options,
                                                const Progress& progress = {});

}  // namespace imunoise::recording
