#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <thread>

#include "cli/commands/commands.h"
#include "cli/interrupt.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "daemon/acquire/clock.h"
#include "daemon/batch/local_engine.h"
#include "daemon/batch/slurm_engine.h"
#include "study/batch/batch_folder.h"
#include "study/batch/batch_plan.h"
#include "study/batch/merge.h"
#include "study/batch/run_shard.h"

namespace imunoise::cli {
namespace {

// Differs between all processes that work at the same time.
std::string writer() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return fmt::format("{}.{}", host.data(), ::getpid());
}

std::unique_ptr<batch::Engine> engine_of(const BatchRunArguments& arguments,
                                         const batch::Worker& worker) {
  if (arguments.slurm)
    return std::make_unique<batch::SlurmEngine>(worker, arguments.workers, arguments.sbatch);
  const std::size_t processors = std::max(1U, std::thread::hardware_concurrency());
  return std::make_unique<batch::LocalEngine>(worker, arguments.workers.value_or(processors));
}

int merge(const std::filesystem::path& folder, const ShowArguments& how) {
  const auto report = study::merge_batch(recording::posix_file_system(), folder);
  if (!report) return print_error(report.error());
  fmt::print(stderr, "wrote {}\n", (folder / study::kMergedName).string());
  return show(*report, how);
}

}  // namespace

int run(const BatchNewArguments& arguments) {
  auto made = study::make_batch(recording::posix_file_system(), arguments.folder, arguments.batch);
  if (!made) return print_error(made.error());
  print(fmt::format("{}: {} shards; imunoise batch run {} works on them\n",
                    arguments.folder.string(), study::shards_of(arguments.batch).size(),
                    arguments.folder.string()));
  return 0;
}

int run(const BatchRunArguments& arguments) {
  const Interrupt interrupt;
  const batch::Worker worker{std::filesystem::read_symlink("/proc/self/exe"),
                             std::filesystem::absolute(arguments.folder)};
  const auto engine = engine_of(arguments, worker);
  const auto status = [&] {
    ProgressLine line("shards");
    return batch::run_batch(recording::posix_file_system(), worker, *engine, arguments.retries,
                            line.progress(interrupt.token()));
  }();
  if (!status) return print_error(status.error());
  if (status->open().empty()) return merge(arguments.folder, arguments.show);
  show(*status, arguments.show);
  return 1;
}

int run(const BatchShardArguments& arguments) {
  const Interrupt interrupt;
  recording::FileSystem& files = recording::posix_file_system();
  const auto shard = study::read_shard(files, arguments.folder, arguments.number);
  if (!shard) return print_error(shard.error());
  auto result = [&] {
    ProgressLine line("shard");
    return study::run_shard(files, shard->shard, acquire::now_ns(),
                            line.progress(interrupt.token()));
  }();
  if (!result) return print_error(result.error());
  result->set_fingerprint(shard->fingerprint);
  const auto written = study::write_result(files, arguments.folder, *result, writer());
  return written ? 0 : print_error(written.error());
}

int run(const BatchStatusArguments& arguments) {
  const auto status = study::batch_status(recording::posix_file_system(), arguments.folder);
  if (!status) return print_error(status.error());
  return show(*status, arguments.show);
}

int run(const BatchMergeArguments& arguments) { return merge(arguments.folder, arguments.show); }

}  // namespace imunoise::cli
