#pragma once

// The campaigns that the daemon was given.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "drivers/host/load.h"
#include "imunoise/v1/campaign.pb.h"

namespace imunoise::app {

struct CampaignFile {
  std::filesystem::path file;
  v1::Campaign campaign;
};

struct CampaignFiles {
  std::vector<CampaignFile> found;
  std::vector<std::string> problems;  ///< All, each with its file and place; empty: all is sound.
};

/// Reads files, and every *.toml of folders, in order of their names. Problems are also: no
/// campaign at all, two of one name, two that record into one folder.
CampaignFiles read_campaigns(std::span<const std::filesystem::path> places,
                             const drivers::Drivers& drivers);

/// What a sound campaign amounts to: "array: 4 devices, 6 replicates of 2 h, every 1 d, at most 3.2
/// GB each time". The size is left out where only an open device knows its streams.
std::string summary(const v1::Campaign& campaign, const drivers::Drivers& drivers);

}  // namespace imunoise::app
