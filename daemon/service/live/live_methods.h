#pragma once

#include "daemon/service/api/methods.h"
#include "daemon/service/campaigns/campaign_control.h"

namespace imunoise::service {

/// Latest samples, figures and parameters of devices that are being recorded.
void add_live_methods(Methods& methods, const CampaignControl& control);

}  // namespace imunoise::service
