#pragma once

#include <chrono>
#include <optional>

#include "daemon/batch/engine.h"

namespace imunoise::batch {

/// "0,3,7-9" of 0, 3, 7, 8, 9, as --array takes it. Precondition: ascending.
std::string array_text(const std::vector<std::uint32_t>& numbers);

/// What squeue says of a job's tasks.
struct Queue {
  std::size_t waiting = 0;
  std::size_t held = 0;     ///< of those that wait: for a person, not for a place
  std::size_t running = 0;  ///< or ending
};

/// Reads the lines "STATE|REASON" of `squeue --format=%T|%r`; what is over is not counted.
Queue queue_of(const std::string& text);

/// Workers are the tasks of job arrays of Slurm. Folder and program lie where every node sees them.
class SlurmEngine final : public Engine {
 public:
  /// At most `workers` tasks run at once; none: as many as Slurm likes. `options` go to sbatch as
  /// they are and win over ours: "--partition=long", "--cpus-per-task=4".
  SlurmEngine(Worker worker, std::optional<std::size_t> workers, std::vector<std::string> options,
              std::chrono::milliseconds look = std::chrono::seconds(2))
      : worker_(std::move(worker)), workers_(workers), options_(std::move(options)), look_(look) {}

  /// One job. Tasks that Slurm holds back for a person are given up when nothing else is left to
  /// wait for. Error: sbatch refuses, or the controller has not answered for five minutes.
  Result<void> run(const std::vector<std::uint32_t>& shards,
                   const std::function<bool()>& go_on) override;

 private:
  Result<std::string> submit(const std::vector<std::uint32_t>& shards) const;

  Worker worker_;
  std::optional<std::size_t> workers_;
  std::vector<std::string> options_;
  std::chrono::milliseconds look_;  ///< between two looks at the queue
};

}  // namespace imunoise::batch
