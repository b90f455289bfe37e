#pragma once

#include <string>

#include "imunoise/v1/campaign.pb.h"

namespace imunoise::app {

/// What a campaign does, in one line: "array: records replicate 2 of 6 into recordings/array/...".
std::string status_text(const v1::CampaignStatus& status);

}  // namespace imunoise::app
