#pragma once

// Runs campaigns side by side, and is the bench of the service.

#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "daemon/acquire/campaign.h"
#include "daemon/acquire/device_recorder.h"
#include "daemon/app/aftercare.h"
#include "daemon/app/campaign_files.h"
#include "daemon/app/log.h"
#include "daemon/live/live_board.h"
#include "daemon/service/bench.h"
#include "recording/store/watched_files.h"

namespace imunoise::app {

/// One thread a campaign. Functions are thread-safe.
class Supervisor : public service::Bench {
 public:
  /// Starts them, but for those with a calendar where the mode is not kOnce: their timers do.
  /// `campaigns` and the others outlive it.
  Supervisor(const std::vector<CampaignFile>& campaigns, const drivers::Drivers& drivers,
             acquire::RunMode mode, Log& log);
  /// Stops them.
  ~Supervisor() override;
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Asks all campaigns for an orderly end; does not wait. None starts any more.
  void stop();
  /// No campaign runs any more.
  bool ended() const { return running_ == 0; }
  /// What each does, in one line.
  std::string status() const;
  /// Logs what is of concern in the replicates that are being recorded, and what keeps campaigns
  /// from recording, once. To be called often, from one thread.
  void tell_warnings();
  /// What hangs, so that a campaign goes no further: its name, what, where and since when. Nothing
  /// while all go on.
  std::optional<std::string> hanging() const;

  std::vector<service::BenchCampaign> campaigns() const override;
  std::vector<v1::LiveReplicate> live() const override { return live_.state(); }
  Result<void> start(const std::string& campaign, bool once) override;
  Result<void> stop(const std::string& campaign, const std::string& recording) override;
  void watch(Watcher changed) override;

 private:
  struct Run {
    service::BenchCampaign state;
    std::stop_source stop;
    std::jthread thread;
  };

  std::optional<live::Trouble> trouble_of(const v1::Campaign& campaign) const;
  std::map<std::string, live::Trouble> troubles() const;
  void tell_troubles();
  bool left_to_timer(const v1::Campaign& campaign) const;
  void begin(Run& run, acquire::RunMode mode);  // with the mutex held
  void run(const v1::Campaign& campaign, acquire::RunMode mode, const std::stop_token& stop);
  void take(const v1::CampaignStatus& status);
  void end(const std::string& campaign);
  void tell(const std::string& campaign);

  const acquire::RunMode mode_;
  Log& log_;
  acquire::SystemClock clock_;
  recording::WatchedFiles files_;
  live::LiveBoard live_;
  acquire::DeviceRecorder recorder_;
  Aftercare aftercare_;
  std::map<std::string, live::Trouble> told_;  // by campaign
  std::atomic<std::size_t> running_ = 0;
  std::mutex watching_;  // held while the watcher is called
  Watcher watcher_;
  mutable std::mutex mutex_;  // guards what follows
  bool ending_ = false;
  std::map<std::string, Run> runs_;  // by campaign; last: their threads use all of the above
};

}  // namespace imunoise::app
