#pragma once

// How much room the disks of the campaigns have.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "daemon/service/campaigns/campaign_control.h"
#include "recording/store/disk/disk_calls.h"

namespace imunoise::service {

/// Looks from a thread of its own: readers of its results never wait for a disk, and a disk
/// that hangs is noticed while no campaign uses it. Thread-safe.
class FreeSpace {
 public:
  FreeSpace(const CampaignControl& control, recording::DiskCalls& calls,
            std::chrono::milliseconds every = std::chrono::seconds(5));

  /// Bytes, by campaign. One whose disk gave no answer lately is not in it.
  std::map<std::string, std::uint64_t> known() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Answer {
    std::uint64_t bytes = 0;
    Clock::time_point when;
  };
  void look(const std::stop_token& stop);

  const CampaignControl& control_;
  recording::DiskCalls& calls_;
  const std::chrono::milliseconds every_;
  mutable std::mutex mutex_;
  std::condition_variable_any over_;
  std::map<std::string, Answer> answers_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace imunoise::service
