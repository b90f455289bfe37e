#pragma once

// The devices of a campaign, checked against what their drivers say of themselves.

#include "daemon/config/table_reader.h"
#include "drivers/host/load.h"
#include "imunoise/v1/campaign.pb.h"

namespace imunoise::config {

/// Reads every [[device]] of a campaign. No device is opened. Problems: no device, two of one name,
/// an unknown driver, an option that its driver has not or does not allow, a required one missing.
void read_devices(TableReader& campaign, const drivers::Drivers& drivers,
                  std::vector<Problem>& problems, v1::Campaign& out);

/// Error: no name for a folder: letters, digits, '_', '-' and '.', no dot in front, at most 64.
Result<void> check_name(std::string_view name);

}  // namespace imunoise::config
