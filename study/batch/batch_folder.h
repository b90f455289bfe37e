#pragma once

// A batch on disk: batch.json, shards/000012.json, results/000012.json, log/000012.txt,
// merged.json. A shard is done when its result is there, can be read, and answers this very shard;
// there is no other state. Every file is there as a whole or not at all.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "imunoise/v1/batch.pb.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::study {

inline constexpr std::string_view kMergedName = "merged.json";

/// "000012"
std::string shard_name(std::uint32_t number);
/// What the worker of a shard said.
std::filesystem::path log_path(const std::filesystem::path& folder, std::uint32_t number);

/// Writes batch and shards into a new folder. Error: check_batch()'s, the disk's, or the folder
/// holds a batch already.
Result<void> make_batch(recording::FileSystem& files, const std::filesystem::path& folder,
                        const v1::Batch& batch);

/// Error: the folder holds no batch, or what is wrong with its file.
Result<v1::Batch> read_batch(const recording::FileSystem& files,
                             const std::filesystem::path& folder);

/// A shard, and the fingerprint of its file. Error: there is none of that number, or it is damaged.
struct Shard {
  v1::BatchShard shard;
  std::string fingerprint;
};
Result<Shard> read_shard(const recording::FileSystem& files, const std::filesystem::path& folder,
                         std::uint32_t number);

/// Error: not JSON, an unknown field, another version.
Result<v1::ShardResult> parse_result(const std::string& text);

/// The result of a shard. Error: it is missing, damaged, or the result of another shard.
Result<v1::ShardResult> read_result(const recording::FileSystem& files,
                                    const std::filesystem::path& folder, std::uint32_t number);

/// Several workers may write the result of one shard at the same time: `writer`, which differs
/// between them, is part of the temporary name.
Result<void> write_result(recording::FileSystem& files, const std::filesystem::path& folder,
                          const v1::ShardResult& result, const std::string& writer);

/// Where the batch is: every result is read. Error: the folder holds no batch.
Result<v1::BatchStatus> batch_status(const recording::FileSystem& files,
                                     const std::filesystem::path& folder);

/// Results that are there by name, whatever is in them: cheap, for progress.
Result<std::size_t> count_results(const recording::FileSystem& files,
                                  const std::filesystem::path& folder);

}  // namespace imunoise::study
