#pragma once

#include "daemon/service/api/methods.h"
#include "daemon/service/campaigns/campaign_control.h"
#include "drivers/host/load.h"

namespace imunoise::service {

/// Devices and campaigns. What they are given outlives the methods.
void add_campaign_methods(Methods& methods, CampaignControl& control,
                          const drivers::Drivers& drivers);

}  // namespace imunoise::service
