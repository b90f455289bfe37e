#include <fmt/format.h>

#include <chrono>

#include "daemon/batch/engine.h"
#include "study/batch/batch_folder.h"

namespace imunoise::batch {
namespace {

constexpr auto kTelling = std::chrono::seconds(1);  // how often progress is told

std::vector<std::uint32_t> numbers_of(const v1::BatchStatus& status) {
  std::vector<std::uint32_t> out;
  for (const v1::ShardStatus& one : status.open()) out.push_back(one.number());
  return out;
}

}  // namespace

Result<v1::BatchStatus> run_batch(recording::FileSystem& files, const Worker& worker,
                                  Engine& engine, std::uint32_t retries, const Progress& progress) {
  auto status = study::batch_status(files, worker.folder);
  if (!status) return status;
  const auto lock = files.lock(worker.folder);
  if (!lock) return fail(worker.folder.string() + ": another imunoise batch run uses it");
  auto told = std::chrono::steady_clock::time_point::min();
  const auto go_on = [&] {
    const auto now = std::chrono::steady_clock::now();
    if (now >= told + kTelling) {
      told = now;
      const auto results = study::count_results(files, worker.folder);
      if (results) progress.report(static_cast<double>(*results) / status->shards());
    }
    return !progress.stopped();
  };
  for (std::uint32_t round = 0; round <= retries && !status->open().empty(); ++round) {
    auto done = engine.run(numbers_of(*status), go_on);
    if (!done) return tl::unexpected(done.error());
    if (progress.stopped()) {
      return fail(fmt::format("{}: stopped; run it again to continue", worker.folder.string()));
    }
    status = study::batch_status(files, worker.folder);
    if (!status) return status;
  }
  return status;
}

}  // namespace imunoise::batch
