#pragma once

// The campaigns that the daemon was given.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "drivers/host/load.h"
#include "imunoise/v1/campaign.pb.h"
#include "imunoise/v1/service.pb.h"

namespace imunoise::app {

struct CampaignFile {
  std::filesystem::path file;
  v1::Campaign campaign;
  std::filesystem::path folder;  ///< Where it records, in one form for all ways to write it.
};

struct CampaignFiles {
  std::vector<CampaignFile> found;
  std::vector<v1::RejectedFile> rejected;  ///< In order of their names; empty: all is sound.
};

/// Reads files, and every *.toml of folders, in order of their names. Rejected is a file that is no
/// sound campaign, whose name or folder is that of a file before it, and a folder without a file.
/// `in_force` are campaigns as they were read before: one whose file is rejected stays as it was,
/// and where two claim one name or folder, the one in force has it.
CampaignFiles read_campaigns(std::span<const std::filesystem::path> places,
                             const drivers::Drivers& drivers,
                             std::span<const CampaignFile> in_force = {});

/// Every problem of every rejected file, with its place.
std::vector<std::string> problems(const CampaignFiles& files);

/// What a sound campaign amounts to: "array: 4 devices, 6 replicates of 2 h, every 1 d, at most 3.2
/// GB each time". The size is left out where only an open device knows its streams.
std::string summary(const v1::Campaign& campaign, const drivers::Drivers& drivers);

}  // namespace imunoise::app
