#pragma once

// What is known of all replicates that are being recorded.

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/acquire/record_replicate.h"
#include "daemon/live/live_device.h"
#include "daemon/live/trouble.h"

namespace imunoise::live {

/// One replicate after the other of one campaign. Thread-safe.
class LiveReplicate : public acquire::ReplicateObserver {
 public:
  explicit LiveReplicate(std::string campaign) : campaign_(std::move(campaign)) {}

  void begin(const acquire::ReplicatePlan& plan,
             const std::vector<v1::RecordedDevice>& devices) override;
  void watch(std::function<recording::RecorderState()> recorder) override;
  void beat() override;
  void join(const v1::RecordedDevice& device) override;
  void take(std::size_t device, const recording::Block& block) override;
  void end() override;

  /// Nothing while none is recorded.
  std::optional<v1::LiveReplicate> state() const;
  /// The latest samples of a device. Error: none is recorded, there is no such device or stream.
  Result<v1::SampleRanges> samples(const v1::GetLiveSamplesRequest& request) const;
  /// What keeps it from being recorded.
  std::optional<Trouble> trouble(Steady::time_point now) const;
  /// Of the warnings that hold now, those that did not at the last call: "imu0: gyro_x: ...".
  std::vector<std::string> new_warnings();

 private:
  struct Watched {
    explicit Watched(const v1::RecordedDevice& device) : live(device) {}
    std::mutex mutex;  // of its reader's thread and of those who look
    LiveDevice live;
  };
  // The current ones: they stay while a caller looks at them.
  std::vector<std::shared_ptr<Watched>> devices() const;

  // Of the recorder; without devices while nothing is recorded.
  recording::RecorderState recorder_state() const;

  std::string campaign_;
  mutable std::mutex asking_;  // held while the recorder is asked
  std::function<recording::RecorderState()> recorder_;
  mutable std::mutex mutex_;  // guards what follows
  v1::LiveReplicate about_;   // without devices
  Steady::time_point beat_;   // of the replicate's own thread
  std::vector<std::shared_ptr<Watched>> devices_;
  std::set<std::string> told_;
};

/// Thread-safe.
class LiveBoard {
 public:
  /// The campaign's place, which lasts as long as the board.
  LiveReplicate& of(const std::string& campaign);
  /// What keeps a campaign's replicate from being recorded.
  std::optional<Trouble> trouble(const std::string& campaign, Steady::time_point now) const;
  /// Replicates that are being recorded, by campaign.
  std::vector<v1::LiveReplicate> state() const;
  /// As LiveReplicate's.
  Result<v1::SampleRanges> samples(const v1::GetLiveSamplesRequest& request) const;
  /// "campaign: imu0: gyro_x: ..."
  std::vector<std::string> new_warnings();

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::unique_ptr<LiveReplicate>> campaigns_;
};

}  // namespace imunoise::live
