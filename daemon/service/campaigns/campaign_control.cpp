#include "daemon/service/campaigns/campaign_control.h"

#include <filesystem>

namespace imunoise::service {

std::string recording_under_way(const v1::CampaignStatus& status) {
  if (status.phase() != v1::recording) return "";
  return std::filesystem::path(status.recording()).filename().string();
}

}  // namespace imunoise::service
