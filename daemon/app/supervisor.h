#pragma once

// Runs campaigns side by side; the service controls them through it.

#include <atomic>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "daemon/acquire/campaign/campaign.h"
#include "daemon/acquire/campaign/campaign_recorder.h"
#include "daemon/app/aftercare.h"
#include "daemon/app/campaign_files.h"
#include "daemon/app/log.h"
#include "daemon/app/troubles.h"
#include "daemon/live/live_board.h"
#include "daemon/service/campaigns/campaign_control.h"
#include "recording/store/disk/watched_files.h"

namespace imunoise::app {

/// One thread a campaign. Functions are thread-safe.
class Supervisor : public service::CampaignControl {
 public:
  /// Starts them, but for those with a calendar where the mode is not kOnce: their timers do. The
  /// drivers, the log and `calls` outlive it. What its campaigns ask of their disks is among the
  /// calls; it tells of any of these that hangs.
  Supervisor(CampaignFiles files, const drivers::Drivers& drivers, acquire::RunMode mode,
             recording::DiskCalls& calls, Log& log);
  /// Stops them.
  ~Supervisor() override;
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Asks all campaigns for an orderly end; does not wait. None starts any more.
  void stop();
  /// These are the campaigns from now on. New ones start; those that are unchanged go on. One that
  /// changed, or is gone, ends first: at once, or once the replicate that it records is complete.
  void reload(CampaignFiles files);
  /// The campaigns as they are to be, for read_campaigns().
  std::vector<CampaignFile> in_force() const;
  /// Goes on with a reload where that had to wait. To be called often.
  void settle();
  /// No campaign runs any more, and none is about to.
  bool ended() const;
  /// What each does, in one line.
  std::string status() const;
  /// Logs what is of concern in the replicates that are being recorded, and what keeps campaigns
  /// from recording, once. To be called often, from one thread.
  void tell_warnings();
  /// What hangs: of which campaign, what, where and since when. Empty while all go on.
  std::string hanging(std::chrono::seconds at_least = live::kHangsAfter) const;

  std::vector<service::CampaignSnapshot> campaigns() const override;
  std::vector<v1::RejectedFile> rejected() const override;
  std::vector<v1::LiveReplicate> live() const override { return live_.state(); }
  Result<v1::SampleRanges> samples(const v1::GetLiveSamplesRequest& request) const override {
    return live_.samples(request);
  }
  std::string trouble() const override;
  Result<void> start(const std::string& campaign, bool once) override;
  Result<void> stop(const std::string& campaign, const std::string& recording) override;
  void watch(Watcher changed) override;

 private:
  struct Run {
    service::CampaignSnapshot state;
    std::filesystem::path folder;  // as its file's
    std::stop_source stop;         // at once
    std::stop_source leave;        // once no replicate is recorded
    bool by_client = false;        // a client stopped it, and may start it again
    std::jthread thread;
  };
  using Runs = std::map<std::string, Run>;

  Troubles troubles() const;
  void tell_troubles();
  bool left_to_timer(const v1::Campaign& campaign) const;
  void run(const v1::Campaign& campaign, acquire::RunMode mode, const std::stop_token& stop,
           const std::stop_token& leave);
  void take(const v1::CampaignStatus& status);
  void end(const std::string& campaign);
  void tell(const std::string& campaign);
  // With the mutex held:
  bool as_wanted(const Runs::value_type& run) const;
  bool folder_is_free(const std::filesystem::path& folder) const;
  void begin(Run& run, acquire::RunMode mode);
  void begin_unless_left(Run& run);
  void tell_changes(const std::map<std::string, CampaignFile>& wanted) const;

  const acquire::RunMode mode_;
  Log& log_;
  acquire::SystemClock clock_;
  recording::DiskCalls& calls_;
  recording::WatchedFiles files_;
  live::LiveBoard live_;
  acquire::CampaignRecorder recorder_;
  Aftercare aftercare_;
  Troubles told_;
  std::atomic<std::size_t> running_ = 0;
  std::mutex watching_;  // held while the watcher is called
  Watcher watcher_;
  mutable std::mutex mutex_;  // guards what follows
  bool ending_ = false;
  std::vector<v1::RejectedFile> rejected_;
  std::map<std::string, CampaignFile> wanted_;  // by campaign
  Runs runs_;  // by campaign, as they are; last: their threads use all of the above
};

}  // namespace imunoise::app
