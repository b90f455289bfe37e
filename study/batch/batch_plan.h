#pragma once

// How a batch is cut into shards. Nothing here touches a disk.

#include <cstddef>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "imunoise/v1/batch.pb.h"

namespace imunoise::study {

inline constexpr std::uint32_t kBatchVersion = 1;

/// As many as a job array of Slurm has when its MaxArraySize is the default of 1001.
inline constexpr std::size_t kMostShards = 1000;

/// The form of a model, its values left open: "WN + RW" of "WN(sigma2=1e-6) + RW(gamma2=1e-14)".
/// Error: it cannot be read.
Result<std::string> form_of(const std::string& model, double rate_hz);

/// The size of shards unless the user says: one recording, or a hundredth of all sets.
std::uint32_t default_shard_size(const v1::Batch& batch);

/// Error: nothing to do, a model that cannot be read or simulated, or more than kMostShards shards.
Result<void> check_batch(const v1::Batch& batch);

/// The shards, in order; together they are the batch. Precondition: check_batch().
std::vector<v1::BatchShard> shards_of(const v1::Batch& batch);

}  // namespace imunoise::study
