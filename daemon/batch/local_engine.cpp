#include "daemon/batch/local_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <list>
#include <thread>

#include "daemon/process/child.h"
#include "study/batch/batch_folder.h"

namespace imunoise::batch {
namespace {

constexpr auto kLook = std::chrono::milliseconds(20);  // how often children are looked after

// A child at work on a shard.
struct Working {
  process::Child child;
  std::uint32_t shard;
};

// True once it ended. A worker that was killed cannot say so itself.
bool ended(Working& one, const std::filesystem::path& folder) {
  if (!one.child.ended()) return false;
  if (one.child.signal()) {
    std::ofstream(study::log_path(folder, one.shard), std::ios::app)
        << fmt::format("imunoise: killed by signal {}\n", *one.child.signal());
  }
  return true;
}

}  // namespace

Result<void> LocalEngine::run(const std::vector<std::uint32_t>& shards,
                              const std::function<bool()>& go_on) {
  const std::size_t processors = std::max(1U, std::thread::hardware_concurrency());
  const std::string threads = std::to_string(std::max<std::size_t>(1, processors / workers_));
  std::list<Working> running;  // those left are ended with this function
  std::size_t next = 0;
  while (next < shards.size() || !running.empty()) {
    if (!go_on()) return {};
    while (running.size() < workers_ && next < shards.size()) {
      const std::uint32_t shard = shards[next++];
      auto child = process::Child::start({worker_.program.string(), "--threads", threads, "batch",
                                          "shard", worker_.folder.string(), std::to_string(shard)},
                                         study::log_path(worker_.folder, shard));
      if (!child) return tl::unexpected(child.error());
      running.push_back({std::move(*child), shard});
    }
    running.remove_if([&](Working& one) { return ended(one, worker_.folder); });
    std::this_thread::sleep_for(kLook);
  }
  return {};
}

}  // namespace imunoise::batch
