#pragma once

#include <cstdint>
#include <filesystem>

#include "core/support/progress.h"
#include "core/support/result.h"
#include "imunoise/v1/batch.pb.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::study {

/// The work of one shard. Of simulations it depends on the shard alone: the same bits on every
/// machine, with any number of threads, and however the sets were cut into shards. `now_ns`, since
/// 1970-01-01 UTC, is when calibrations say that they were made. The fingerprint is left open.
/// Error: a recording that cannot be calibrated, a model that the sets are too short for, or the
/// caller stopped it.
Result<v1::ShardResult> run_shard(const recording::FileSystem& files, const v1::BatchShard& shard,
                                  std::int64_t now_ns, const Progress& progress = {});

}  // namespace imunoise::study
