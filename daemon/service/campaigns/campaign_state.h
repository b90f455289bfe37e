#pragma once

#include <cstdint>

#include "daemon/service/campaigns/campaign_control.h"
#include "imunoise/v1/service.pb.h"

namespace imunoise::service {

/// What the API says of a campaign at a time (nanoseconds since 1970-01-01 UTC). Progress and time
/// left are known while a replicate is recorded, and while the sensors settle before a new
/// recording.
v1::CampaignState campaign_state(const CampaignSnapshot& campaign, std::int64_t now_ns);

}  // namespace imunoise::service
