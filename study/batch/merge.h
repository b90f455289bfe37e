#pragma once

#include <filesystem>
#include <vector>

#include "core/support/result.h"
#include "imunoise/v1/batch.pb.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::study {

/// All fits in order of their sets, and what they say of each parameter. Where the model fitted has
/// the terms of the true one, its values are compared with the truth.
v1::SimulationSummary summarise(const v1::SimulationTask& task,
                                const std::vector<v1::ShardResult>& results);

/// Puts the results of all shards together: merged.json, and calibrations beside their recordings.
/// The same bytes for simulations however they were cut into shards. Error: shards without a
/// result, or a folder that cannot be written.
Result<v1::BatchReport> merge_batch(recording::FileSystem& files,
                                    const std::filesystem::path& folder);

}  // namespace imunoise::study
