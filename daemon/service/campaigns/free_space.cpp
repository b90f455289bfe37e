#include "daemon/service/campaigns/free_space.h"

#include "recording/store/disk/watched_files.h"

namespace imunoise::service {

FreeSpace::FreeSpace(const CampaignControl& control, recording::DiskCalls& calls,
                     std::chrono::milliseconds every)
    : control_(control), calls_(calls), every_(every) {
  thread_ = std::jthread([this](const std::stop_token& stop) { look(stop); });
}

std::map<std::string, std::uint64_t> FreeSpace::known() const {
  const Clock::time_point oldest = Clock::now() - 3 * every_;
  std::map<std::string, std::uint64_t> out;
  const std::lock_guard lock(mutex_);
  for (const auto& [campaign, answer] : answers_) {
    if (answer.when >= oldest) out[campaign] = answer.bytes;
  }
  return out;
}

void FreeSpace::look(const std::stop_token& stop) {
  const recording::WatchedFiles files(recording::posix_file_system(), calls_);
  while (!stop.stop_requested()) {
    for (const CampaignSnapshot& one : control_.campaigns()) {
      const auto free = files.free_space(one.campaign.folder());
      if (stop.stop_requested()) return;
      const std::lock_guard lock(mutex_);
      if (free) answers_[one.campaign.name()] = {*free, Clock::now()};
    }
    std::unique_lock lock(mutex_);
    over_.wait_for(lock, stop, every_, [] { return false; });
  }
}

}  // namespace imunoise::service
