#pragma once

// Runs campaigns side by side.

#include <atomic>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "daemon/acquire/campaign.h"
#include "daemon/acquire/device_recorder.h"
#include "daemon/app/campaign_files.h"
#include "daemon/app/log.h"

namespace imunoise::app {

/// One thread a campaign. Functions are thread-safe.
class Supervisor {
 public:
  /// Starts them. `campaigns` and the others outlive it.
  Supervisor(const std::vector<CampaignFile>& campaigns, const drivers::Drivers& drivers,
             acquire::RunMode mode, Log& log);
  /// Stops them.
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Asks all campaigns for an orderly end; does not wait.
  void stop() { source_.request_stop(); }
  /// No campaign runs any more.
  bool ended() const { return running_ == 0; }
  /// What each does, in one line.
  std::string status() const;

 private:
  void run(const v1::Campaign& campaign, acquire::RunMode mode);
  void take(const v1::CampaignStatus& status);

  Log& log_;
  acquire::SystemClock clock_;
  acquire::DeviceRecorder recorder_;
  std::stop_source source_;
  std::atomic<std::size_t> running_ = 0;
  mutable std::mutex mutex_;
  std::map<std::string, v1::CampaignStatus> states_;  // by campaign
  std::vector<std::jthread> threads_;                 // last: they use all of the above
};

}  // namespace imunoise::app
