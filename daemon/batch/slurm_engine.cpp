#include "daemon/batch/slurm_engine.h"

#include <fmt/format.h>

#include <sstream>
#include <thread>

#include "daemon/process/child.h"
#include "study/batch/batch_folder.h"

namespace imunoise::batch {
namespace {

constexpr auto kPatience = std::chrono::minutes(5);  // with a controller that does not answer

// The arguments say the rest, so that no name needs quoting.
constexpr std::string_view kScript = R"(#!/bin/sh
# One shard of a batch: sbatch --array=NUMBERS shard.sh PROGRAM FOLDER
exec "$1" --threads "${SLURM_CPUS_PER_TASK:-1}" batch shard "$2" "$SLURM_ARRAY_TASK_ID"
)";

// A path with what sbatch takes for a pattern doubled.
std::string without_patterns(const std::string& path) {
  std::string out;
  for (const char c : path) out += c == '%' ? "%%" : std::string(1, c);
  return out;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

// Nothing when the controller did not answer. A job that is long over is unknown to it.
std::optional<Queue> prepare_channel(const std::string& job) {
  const auto said =
      process::ask({"squeue", "--noheader", "--array", "--jobs=" + job, "--format=%T|%r"});
  if (!said) return std::nullopt;
  if (said->status == 0) return queue_of(said->text);
  if (said->text.find("Invalid job id") != std::string::npos) return Queue{};
  return std::nullopt;
}

void cancel(const std::string& job) { static_cast<void>(process::ask({"scancel", job})); }

}  // namespace

std::string array_text(const std::vector<std::uint32_t>& numbers) {
  std::string out;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    out += fmt::format("{}{}", out.empty() ? "" : ",", numbers[i]);
    if (last > i) out += fmt::format("-{}", numbers[last]);
    i = last + 1;
  }
  return out;
}

Queue queue_of(const std::string& text) {
  Queue out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t bar = line.find('|');
    const std::string state = line.substr(0, bar);
    const std::string reason = bar == std::string::npos ? "" : line.substr(bar + 1);
    if (state == "PENDING") {
      ++out.waiting;
      const bool held = reason.find("held") != std::string::npos ||
                        reason.find("Held") != std::string::npos || reason == "BadConstraints";
      if (held) ++out.held;
    } else if (state == "RUNNING" || state == "COMPLETING" || state == "CONFIGURING" ||
               state == "SUSPENDED" || state == "STOPPED" || state == "REQUEUED" ||
               state == "STAGE_OUT" || state == "SIGNALING" || state == "RESIZING") {
      ++out.running;
    }
  }
  return out;
}

Result<std::string> SlurmEngine::submit(const std::vector<std::uint32_t>& shards) const {
  const std::filesystem::path script = worker_.folder / "shard.sh";
  auto written = recording::replace_file(recording::posix_file_system(), script, kScript);
  if (!written) return tl::unexpected(written.error());
  std::vector<std::string> words = {
      "sbatch", "--parsable", "--job-name=imunoise", "--requeue", "--open-mode=append",
      "--chdir=" + worker_.folder.string(),
      // As log_path() names it: six digits.
      "--output=" + without_patterns((worker_.folder / "log").string()) + "/%6a.txt",
      fmt::format("--array={}{}", array_text(shards),
                  workers_ ? fmt::format("%{}", *workers_) : "")};
  words.insert(words.end(), options_.begin(), options_.end());
  words.insert(words.end(), {script.string(), worker_.program.string(), worker_.folder.string()});
  const auto said = process::ask(words);
  if (!said) return tl::unexpected(said.error());
  if (said->status != 0) return fail("sbatch: " + first_line(said->text));
  const std::string line = first_line(said->text);
  return line.substr(0, line.find(';'));  // NUMBER;CLUSTER
}

Result<void> SlurmEngine::run(const std::vector<std::uint32_t>& shards,
                              const std::function<bool()>& go_on) {
  const auto job = submit(shards);
  if (!job) return tl::unexpected(job.error());
  auto answered = std::chrono::steady_clock::now();
  for (;;) {
    if (!go_on()) {
      cancel(*job);
      return {};
    }
    const auto now = std::chrono::steady_clock::now();
    if (const auto queue = prepare_channel(*job)) {
      answered = now;
      if (queue->running == 0 && queue->waiting == queue->held) {
        if (queue->held > 0) cancel(*job);
        return {};
      }
    } else if (now - answered > kPatience) {
      return fail(
          fmt::format("squeue: the controller does not answer; job {} may still run. imunoise "
                      "batch run continues later",
                      *job));
    }
    std::this_thread::sleep_for(look_);
  }
}

}  // namespace imunoise::batch
