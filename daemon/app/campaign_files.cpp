#include "daemon/app/campaign_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "core/support/counted.h"
#include "core/support/utf8.h"
#include "daemon/acquire/disk_space.h"
#include "daemon/acquire/recorded_device.h"
#include "daemon/config/campaign_config.h"
#include "daemon/config/quantity_text.h"

namespace imunoise::app {
namespace {

namespace fs = std::filesystem;

// The file itself, or what the folder holds. Error: the folder cannot be listed.
Result<std::vector<fs::path>> files_at(const fs::path& place) {
  std::error_code trouble;
  if (!fs::is_directory(place, trouble)) return std::vector{place};
  std::vector<fs::path> out;
  fs::directory_iterator entry(place, trouble);
  for (; !trouble && entry != fs::directory_iterator(); entry.increment(trouble)) {
    if (entry->path().extension() == ".toml") out.push_back(entry->path());
  }
  if (trouble)
    return fail(fmt::format("{}: cannot be listed: {}", place.string(), trouble.message()));
  std::sort(out.begin(), out.end());
  return out;
}

// In one form for all ways to write it.
fs::path folder_of(const v1::Campaign& campaign) {
  std::error_code trouble;
  const fs::path out = fs::weakly_canonical(fs::absolute(campaign.folder(), trouble), trouble);
  return out.has_filename() ? out : out.parent_path();  // "x/" is "x"
}

// Gives each name and each folder to one campaign.
class Selection {
 public:
  explicit Selection(std::span<const CampaignFile> in_force) : in_force_(in_force) {}

  void read(const fs::path& place, const drivers::Drivers& drivers) {
    const auto files = files_at(place);
    if (!files) return reject(place, {files.error().message});
    if (files->empty()) {  // what was there is gone
      complain(place, {fmt::format("{}: contains no campaign files (*.toml)", place.string())});
    }
    for (const fs::path& file : *files) {
      std::error_code trouble;
      if (file == place || fs::is_regular_file(file, trouble)) {
        read_file(file, drivers);
      } else {  // a pipe would be waited for
        reject(file, {file.string() + ": is not a regular file"});
      }
    }
  }

  CampaignFiles finish() {
    for (CampaignFile& one : std::exchange(kept_, {})) accept(std::move(one));
    std::stable_partition(read_.begin(), read_.end(), [this](const CampaignFile& one) {
      const CampaignFile* const before = version_in_force(one.file);
      return before != nullptr && before->campaign.name() == one.campaign.name();
    });
    for (CampaignFile& one : read_) accept(std::move(one));
    for (CampaignFile& one : std::exchange(kept_, {})) accept(std::move(one));
    const auto by_file = [](const auto& a, const auto& b) { return a.file() < b.file(); };
    std::stable_sort(out_.rejected.begin(), out_.rejected.end(), by_file);
    return std::move(out_);
  }

 private:
  void read_file(const fs::path& file, const drivers::Drivers& drivers) {
    auto read = config::read_campaign(file, drivers);
    if (read && read->problems.empty()) {
      fs::path folder = folder_of(read->campaign);
      read_.push_back({file, std::move(read->campaign), std::move(folder)});
      return;
    }
    std::vector<std::string> problems;
    if (!read) problems.push_back(read.error().message);
    if (read) {
      for (const config::Problem& one : read->problems)
        problems.push_back(config::describe(file.string(), one));
    }
    reject(file, problems);
  }

  void accept(CampaignFile one) {
    const std::vector<std::string> problems = twins_of(one);
    if (!problems.empty()) return reject(one.file, problems);
    out_.found.push_back(std::move(one));
  }

  std::vector<std::string> twins_of(const CampaignFile& one) const {
    std::vector<std::string> out;
    for (const CampaignFile& other : out_.found) {
      if (other.campaign.name() == one.campaign.name()) {
        out.push_back(fmt::format("{}: has the same name '{}' as {}; rename one", one.file.string(),
                                  one.campaign.name(), other.file.string()));
      }
      if (other.folder == one.folder) {
        out.push_back(
            fmt::format("{}: has the same folder {} as {}; give each campaign its own folder",
                        one.file.string(), one.campaign.folder(), other.file.string()));
      }
    }
    return out;
  }

  // What the file, or the folder, held before stays.
  void reject(const fs::path& place, const std::vector<std::string>& problems) {
    if (!complain(place, problems)) return;
    const fs::path as_parent = (place / "x").parent_path();
    for (const CampaignFile& one : in_force_) {
      if (one.file == place || one.file.parent_path() == as_parent) kept_.push_back(one);
    }
  }

  // True for the first complaint about it.
  bool complain(const fs::path& place, const std::vector<std::string>& problems) {
    const std::string file = repaired_utf8(place.string());
    const auto known = std::find_if(out_.rejected.begin(), out_.rejected.end(),
                                    [&](const auto& one) { return one.file() == file; });
    const bool first = known == out_.rejected.end();
    v1::RejectedFile& to = first ? out_.rejected.emplace_back() : *known;
    to.set_file(file);
    for (const std::string& problem : problems) to.add_problems(repaired_utf8(problem));
    return first;
  }

  const CampaignFile* version_in_force(const fs::path& file) const {
    const auto found = std::find_if(in_force_.begin(), in_force_.end(),
                                    [&](const CampaignFile& one) { return one.file == file; });
    return found == in_force_.end() ? nullptr : &*found;
  }

  std::span<const CampaignFile> in_force_;
  std::vector<CampaignFile> read_;
  std::vector<CampaignFile> kept_;  // as they were in force
  CampaignFiles out_;
};

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

CampaignFiles read_campaigns(std::span<const fs::path> places, const drivers::Drivers& drivers,
                             std::span<const CampaignFile> in_force) {
  Selection out(in_force);
  for (const fs::path& place : places) out.read(place, drivers);
  return out.finish();
}

std::vector<std::string> problems(const CampaignFiles& files) {
  std::vector<std::string> out;
  for (const v1::RejectedFile& one : files.rejected)
    out.insert(out.end(), one.problems().begin(), one.problems().end());
  return out;
}

std::string summary(const v1::Campaign& campaign, const drivers::Drivers& drivers) {
  const auto bytes = size_of(campaign, drivers);
  return fmt::format("{}: {}, {} of {}, {}{}", campaign.name(),
                     counted(campaign.devices_size(), "device"),
                     counted(campaign.replicates(), "replicate"),
                     config::print_duration(campaign.length_s()), rhythm(campaign.schedule()),
                     bytes ? ", at most " + config::print_bytes(*bytes) + " each time" : "");
}

}  // namespace imunoise::app
