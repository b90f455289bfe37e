#pragma once

// Records the replicates of campaigns from real devices.

#include "daemon/acquire/campaign/campaign.h"
#include "daemon/acquire/record_replicate.h"
#include "drivers/host/load.h"

namespace imunoise::acquire {

/// Devices that fail are opened again while a replicate lasts; those that do not come are missing
/// in it. Thread-safe.
class CampaignRecorder : public ReplicateRecorder {
 public:
  /// Observers are asked for by campaign; they outlive it.
  using Observers = std::function<ReplicateObserver*(const std::string& campaign)>;

  CampaignRecorder(recording::FileSystem& files, const drivers::Drivers& drivers, DeviceNote note,
                   Observers observers = {})
      : files_(files),
        drivers_(drivers),
        note_(std::move(note)),
        observers_(std::move(observers)) {}

  Result<v1::ReplicateNote> record(const v1::Campaign& campaign, const ReplicateTask& task,
                                   const Progress& progress) override;

 private:
  recording::FileSystem& files_;
  const drivers::Drivers& drivers_;
  DeviceNote note_;
  Observers observers_;
};

}  // namespace imunoise::acquire
