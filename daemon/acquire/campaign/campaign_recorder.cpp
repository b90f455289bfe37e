#include "daemon/acquire/campaign/campaign_recorder.h"

namespace imunoise::acquire {
namespace {

Result<std::vector<DevicePlan>> devices_of(const v1::Campaign& campaign,
                                           const drivers::Drivers& drivers) {
  std::vector<DevicePlan> out;
  for (const v1::CampaignDevice& device : campaign.devices()) {
    const auto driver = drivers.find(device.driver());
    if (!driver) return tl::make_unexpected(driver.error());
    DevicePlan& plan = out.emplace_back(DevicePlan{device.name(), **driver, {}});
    for (const v1::CampaignOption& option : device.options()) {
      plan.options.push_back({option.name(), option.value()});
    }
  }
  return out;
}

}  // namespace

Result<v1::ReplicateNote> CampaignRecorder::record(const v1::Campaign& campaign,
                                                   const ReplicateTask& task,
                                                   const Progress& progress) {
  auto devices = devices_of(campaign, drivers_);
  if (!devices) return tl::make_unexpected(devices.error());
  ReplicatePlan plan;
  plan.folder = task.folder;
  plan.replicate = task.replicate;
  plan.unfinished = task.unfinished;
  plan.devices = std::move(*devices);
  plan.duration = std::chrono::duration<double>(campaign.length_s());
  plan.wire = campaign.wire();
  plan.campaign = campaign.name();
  plan.patience = std::chrono::duration<double>(campaign.patience_s());
  plan.reopening = Reopening{};
  plan.reserve_bytes = campaign.reserve_bytes();
  plan.replicates_to_come = task.replicates_to_come;
  if (observers_) plan.observer = observers_(campaign.name());
  const auto outcome = record_replicate(files_, plan, note_, progress);
  if (!outcome) return tl::make_unexpected(outcome.error());
  return outcome->note;
}

}  // namespace imunoise::acquire
