#pragma once

// A campaign as people write it: a TOML file. docs/campaigns.md explains every key.

#include <filesystem>
#include <string_view>
#include <vector>

#include "daemon/config/problem.h"
#include "drivers/host/load.h"
#include "imunoise/v1/campaign.pb.h"

namespace imunoise::config {

struct CampaignConfig {
  v1::Campaign campaign;          ///< Usable only where there are no problems.
  std::vector<Problem> problems;  ///< All of them, in the order of the file.
};

/// Reads the text of a file. Options of devices are checked against what the drivers say of
/// themselves; nothing is opened. Where the text is no TOML, the first error of its form is the
/// only problem. Thread-safe.
CampaignConfig parse_campaign(std::string_view text, const drivers::Drivers& drivers);

/// The same of a file of at most 1 MiB. Error: it cannot be read.
Result<CampaignConfig> read_campaign(const std::filesystem::path& file,
                                     const drivers::Drivers& drivers);

}  // namespace imunoise::config
