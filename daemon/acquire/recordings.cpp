#include "daemon/acquire/recordings.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "recording/store/layout.h"
#include "recording/store/manifest.h"

namespace imunoise::acquire {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kShape = "0000-00-00T000000Z";

// The number in text[at, at + digits).
int number_at(std::string_view text, std::size_t at, std::size_t digits) {
  int out = 0;
  std::from_chars(text.data() + at, text.data() + at + digits, out);
  return out;
}

bool has_shape(std::string_view name) {
  if (name.size() != kShape.size()) return false;
  return std::equal(name.begin(), name.end(), kShape.begin(), [](char c, char shape) {
    return shape == '0' ? c >= '0' && c <= '9' : c == shape;
  });
}

struct Listed {
  fs::path folder;
  Time started;
};

// Folders named like recordings, the newest first. A campaign's folder that is not there has none.
Result<std::vector<Listed>> list_recordings(const recording::FileSystem& files,
                                            const fs::path& root) {
  std::vector<Listed> out;
  std::error_code trouble;
  if (!fs::exists(root, trouble)) return out;
  const auto names = files.list(root);
  if (!names) return tl::make_unexpected(names.error());
  for (const std::string& name : *names) {
    if (!name.ends_with('/')) continue;
    const std::string folder = name.substr(0, name.size() - 1);
    if (const auto started = start_of(folder)) out.push_back({root / folder, *started});
  }
  std::reverse(out.begin(), out.end());  // names are sorted, as their times are
  return out;
}

Result<std::uint32_t> last_replicate(const recording::FileSystem& files, const fs::path& folder) {
  const auto names = files.list(folder);
  if (!names) return tl::make_unexpected(names.error());
  std::uint32_t last = 0;
  for (const std::string& name : *names) {
    if (!name.ends_with('/')) continue;
    last = std::max(last, recording::replicate_of(name.substr(0, name.size() - 1)).value_or(0));
  }
  return last;
}

bool is_of(const v1::Manifest& manifest, const v1::Campaign& campaign) {
  return manifest.campaign() == campaign.name();
}

}  // namespace

std::string recording_name(Time started) {
  const auto whole = std::chrono::floor<std::chrono::seconds>(started);
  return fmt::format("{:%Y-%m-%dT%H%M%S}Z", fmt::gmtime(whole.time_since_epoch().count()));
}

std::optional<Time> start_of(std::string_view name) {
  using namespace std::chrono;
  if (!has_shape(name)) return std::nullopt;
  const year_month_day day(year(number_at(name, 0, 4)),
                           month(static_cast<unsigned>(number_at(name, 5, 2))),
                           std::chrono::day(static_cast<unsigned>(number_at(name, 8, 2))));
  const int hour = number_at(name, 11, 2);
  const int minute = number_at(name, 13, 2);
  const int second = number_at(name, 15, 2);
  if (!day.ok() || hour > 23 || minute > 59 || second > 59) return std::nullopt;
  return Time(sys_days(day)) + hours(hour) + minutes(minute) + seconds(second);
}

Result<std::optional<FoundRecording>> newest_recording(const recording::FileSystem& files,
                                                       const v1::Campaign& campaign) {
  const auto listed = list_recordings(files, campaign.folder());
  if (!listed) return tl::make_unexpected(listed.error());
  for (const Listed& one : *listed) {
    const auto manifest = recording::read_manifest(files, one.folder);
    if (!manifest) return tl::make_unexpected(manifest.error());
    if (*manifest && !is_of(**manifest, campaign)) continue;
    FoundRecording out{one.folder, {one.started, {}, 0}};
    const auto last = last_replicate(files, one.folder);
    if (!last) return tl::make_unexpected(last.error());
    out.state.last_replicate = *last;
    if (*manifest) {
      const auto& notes = (*manifest)->replicates();
      out.state.notes.assign(notes.begin(), notes.end());
    }
    return std::optional(std::move(out));
  }
  return std::optional<FoundRecording>();
}

Result<std::vector<fs::path>> tidy_recordings(const recording::FileSystem& files,
                                              const v1::Campaign& campaign, Time now) {
  const v1::CampaignRetention& keep = campaign.retention();
  std::vector<fs::path> out;
  if (keep.recordings() == 0 && !keep.has_age_s()) return out;
  const auto listed = list_recordings(files, campaign.folder());
  if (!listed) return tl::make_unexpected(listed.error());
  std::uint32_t kept = 0;
  for (const Listed& one : *listed) {
    const auto manifest = recording::read_manifest(files, one.folder);
    if (!manifest || !*manifest || !is_of(**manifest, campaign)) continue;
    const std::chrono::duration<double> age = now - one.started;
    const bool too_many = keep.recordings() > 0 && kept >= keep.recordings();
    const bool too_old = keep.has_age_s() && age.count() > keep.age_s();
    if (kept == 0 || !(*manifest)->closed() || (!too_many && !too_old)) {
      ++kept;
      continue;
    }
    std::error_code trouble;
    fs::remove_all(one.folder, trouble);
    if (trouble) {
      return fail(fmt::format("{}: is no longer to be kept, and cannot be deleted: {}",
                              one.folder.string(), trouble.message()));
    }
    out.push_back(one.folder);
  }
  return out;
}

}  // namespace imunoise::acquire
