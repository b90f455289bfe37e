#include "daemon/app/campaign_reload.h"

#include <chrono>
#include <utility>

namespace imunoise::app {

std::optional<CampaignFiles> CampaignReload::poll(const InForce& in_force) {
  if (requested_ && !reading_.valid()) {
    requested_ = false;
    reading_ = std::async(std::launch::async, [this, before = in_force()] {
      const recording::DiskCalls::Watch watch(calls_, "reading of the campaign files",
                                              places_.front());
      return read_campaigns(places_, drivers_, before);
    });
  }
  if (!reading_.valid() || reading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return std::nullopt;
  return reading_.get();
}

}  // namespace imunoise::app
