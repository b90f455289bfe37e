#include "daemon/app/campaign_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <system_error>

#include "daemon/acquire/disk_space.h"
#include "daemon/acquire/recorded_device.h"
#include "daemon/config/campaign_config.h"
#include "daemon/config/quantity_text.h"

namespace imunoise::app {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_at(const fs::path& place) {
  std::error_code trouble;
  if (!fs::is_directory(place, trouble)) return {place};
  std::vector<fs::path> out;
  for (const fs::directory_entry& entry : fs::directory_iterator(place, trouble)) {
    if (entry.path().extension() == ".toml") out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

void read_file(const fs::path& file, const drivers::Drivers& drivers, CampaignFiles& out) {
  auto read = config::read_campaign(file, drivers);
  if (!read) {
    out.problems.push_back(read.error().message);
    return;
  }
  for (const config::Problem& one : read->problems) {
    out.problems.push_back(config::describe(file.string(), one));
  }
  if (read->problems.empty()) out.found.push_back({file, std::move(read->campaign)});
}

void refuse_twins(CampaignFiles& files) {
  std::map<std::string, fs::path> names;
  std::map<fs::path, fs::path> folders;
  for (const CampaignFile& one : files.found) {
    std::error_code trouble;
    const fs::path folder =
        fs::weakly_canonical(fs::absolute(one.campaign.folder(), trouble), trouble);
    const auto name = names.emplace(one.campaign.name(), one.file);
    if (!name.second) {
      files.problems.push_back(fmt::format("{}: the name '{}' is that of {} too; rename one",
                                           one.file.string(), one.campaign.name(),
                                           name.first->second.string()));
    }
    const auto at = folders.emplace(folder, one.file);
    if (!at.second) {
      files.problems.push_back(
          fmt::format("{}: the folder {} is that of {} too; give each a folder of its own",
                      one.file.string(), one.campaign.folder(), at.first->second.string()));
    }
  }
}

// Bytes of one recording, where the drivers know their streams without a device.
std::optional<double> size_of(const v1::Campaign& campaign, const drivers::Drivers& drivers) {
  double rate = 0.0;
  for (const v1::CampaignDevice& device : campaign.devices()) {
    const auto driver = drivers.find(device.driver());
    if (!driver || (*driver)->info.streams.empty()) return std::nullopt;
    const drivers::DeviceInfo usual{(*driver)->info.streams};
    rate +=
        acquire::bytes_per_second(acquire::recorded_device(device.name(), device.driver(), usual));
  }
  return rate * campaign.length_s() * campaign.replicates();
}

std::string rhythm(const v1::CampaignSchedule& schedule) {
  if (schedule.has_every_s()) return "every " + config::print_duration(schedule.every_s());
  if (!schedule.calendar().empty()) return "by a timer, " + schedule.calendar();
  return "once";
}

}  // namespace

CampaignFiles read_campaigns(std::span<const fs::path> places, const drivers::Drivers& drivers) {
  CampaignFiles out;
  for (const fs::path& place : places) {
    const std::vector<fs::path> files = files_at(place);
    if (files.empty()) {
      out.problems.push_back(fmt::format("{}: holds no campaign (*.toml)", place.string()));
    }
    for (const fs::path& file : files) read_file(file, drivers, out);
  }
  refuse_twins(out);
  return out;
}

std::string summary(const v1::Campaign& campaign, const drivers::Drivers& drivers) {
  const auto bytes = size_of(campaign, drivers);
  return fmt::format("{}: {} device{}, {} replicate{} of {}, {}{}", campaign.name(),
                     campaign.devices_size(), campaign.devices_size() == 1 ? "" : "s",
                     campaign.replicates(), campaign.replicates() == 1 ? "" : "s",
                     config::print_duration(campaign.length_s()), rhythm(campaign.schedule()),
                     bytes ? ", at most " + config::print_bytes(*bytes) + " each time" : "");
}

}  // namespace imunoise::app
