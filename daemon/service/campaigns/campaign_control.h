#pragma once

// Acquisition, as the service sees it. The daemon's supervisor implements it; tests have their own.

#include <functional>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "imunoise/v1/campaign.pb.h"
#include "imunoise/v1/live.pb.h"
#include "imunoise/v1/service.pb.h"

namespace imunoise::service {

/// A campaign, and what it told last.
struct CampaignSnapshot {
  v1::Campaign campaign;
  v1::CampaignStatus status;
  bool running = false;
  std::string trouble = {};  ///< What keeps it from recording, where, since when; empty: nothing.
};

/// Name of the recording of which a replicate is being recorded: "2026-03-01T060000Z"; empty: none.
std::string recording_under_way(const v1::CampaignStatus& status);

/// Functions are thread-safe and do not wait for recording.
class CampaignControl {
 public:
  using Watcher = std::function<void(const std::string& campaign)>;

  virtual ~CampaignControl() = default;
  /// All, in order of their names.
  virtual std::vector<CampaignSnapshot> campaigns() const = 0;
  /// Files of campaigns that were not taken up.
  virtual std::vector<v1::RejectedFile> rejected() const = 0;
  /// What hangs outside of the campaigns' folders, where, since when; empty: nothing.
  virtual std::string trouble() const = 0;
  /// What is known of the replicates that are being recorded.
  virtual std::vector<v1::LiveReplicate> live() const = 0;
  /// The latest samples of a device that is being recorded. Error: it is not, or there is no such
  /// stream, channel or size of ranges.
  virtual Result<v1::SampleRanges> samples(const v1::GetLiveSamplesRequest& request) const = 0;
  /// Error: it runs already, or is not for us to start; says the way out.
  virtual Result<void> start(const std::string& campaign, bool once) = 0;
  /// Asks for an orderly end, and does not wait for it. Nothing stops a recording by accident:
  /// while a replicate is recorded, `recording` has to be the name of its recording. Error: it is
  /// not (says which one, and what would be lost), or the campaign does not run.
  virtual Result<void> stop(const std::string& campaign, const std::string& recording) = 0;
  /// `changed` is called after each change of a campaign, from its thread; it must not wait. Empty:
  /// no watcher; afterwards the previous one is not running.
  virtual void watch(Watcher changed) = 0;
};

}  // namespace imunoise::service
