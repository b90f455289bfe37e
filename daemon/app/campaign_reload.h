#pragma once

// Reads the campaign files again, on a thread of its own: a disk that hangs keeps no other waiting.

#include <functional>
#include <future>
#include <optional>
#include <vector>

#include "daemon/app/campaign_files.h"
#include "recording/store/disk/disk_calls.h"

namespace imunoise::app {

/// From one thread. Destroyed, it waits for a reading that is under way.
class CampaignReload {
 public:
  using InForce = std::function<std::vector<CampaignFile>()>;

  /// `drivers` and `calls` outlive it; what hangs is among the calls.
  CampaignReload(std::vector<std::filesystem::path> places, const drivers::Drivers& drivers,
                 recording::DiskCalls& calls)
      : places_(std::move(places)), drivers_(drivers), calls_(calls) {}

  /// Asks for a reading, which begins when the one under way has ended.
  void request() { requested_ = true; }
  /// What was read, once. To be called often. `in_force` as read_campaigns() takes it.
  std::optional<CampaignFiles> poll(const InForce& in_force);

 private:
  const std::vector<std::filesystem::path> places_;
  const drivers::Drivers& drivers_;
  recording::DiskCalls& calls_;
  bool requested_ = false;
  std::future<CampaignFiles> reading_;
};

}  // namespace imunoise::app
