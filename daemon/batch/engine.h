#pragma once

// What runs the shards of a batch. An engine only starts workers; whether a shard is done is read
// from its result.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/support/progress.h"
#include "core/support/result.h"
#include "imunoise/v1/batch.pb.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::batch {

/// The program that works on a shard: `program --threads N batch shard FOLDER NUMBER`.
struct Worker {
  std::filesystem::path program;  ///< absolute
  std::filesystem::path folder;   ///< of the batch; absolute
};

class Engine {
 public:
  virtual ~Engine() = default;
  /// Starts a worker for each of these shards and returns when none of them runs any more, however
  /// they ended. Asks `go_on` every few seconds at least; told not to, it ends them first. Error:
  /// no worker can be started.
  virtual Result<void> run(const std::vector<std::uint32_t>& shards,
                           const std::function<bool()>& go_on) = 0;
};

/// Runs the shards that have no result, those that then still have none again, and so on: at most
/// 1 + `retries` rounds. Returns where the batch is then; shards may be open. Error: no batch,
/// another process runs it, the engine's, or the caller stopped it.
Result<v1::BatchStatus> run_batch(recording::FileSystem& files, const Worker& worker,
                                  Engine& engine, std::uint32_t retries, const Progress& progress);

}  // namespace imunoise::batch
