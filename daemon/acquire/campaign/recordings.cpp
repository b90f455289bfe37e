#include "daemon/acquire/campaign/recordings.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "recording/store/format/layout.h"
#include "recording/store/manifest/manifest.h"

namespace imunoise::acquire {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kShape = "0000-00-00T000000Z";
constexpr std::chrono::seconds kSameSecond{1};  // names are whole seconds

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
  const auto there = files.exists(root);
  if (!there) return tl::make_unexpected(there.error());
  if (!*there) return out;
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

// A recording, and when it began by the clock as it is set now.
struct Dated {
  fs::path folder;
  Time began;
  std::optional<v1::Manifest> manifest;
};

bool of_this_boot(const v1::ReplicateNote& note, const Clock& clock) {
  return !note.boot_id().empty() && note.boot_id() == clock.boot_id();
}

std::chrono::nanoseconds time_since(const v1::ReplicateNote& note, const Clock& clock) {
  return clock.since_boot() - std::chrono::nanoseconds(note.started_since_boot_ns());
}

// When a recording that was named `named` began. Of those made since the machine started the time
// since then tells, however the clock was set.
Time began(Time named, const v1::Manifest& manifest, const Clock& clock) {
  if (manifest.replicates().empty() || !of_this_boot(manifest.replicates(0), clock)) return named;
  const v1::ReplicateNote& first = manifest.replicates(0);
  const auto leap = (clock.now() - time_since(first, clock)).time_since_epoch() -
                    std::chrono::nanoseconds(first.started_ns());
  return std::chrono::abs(leap) < kLeastLeap ? named : named + leap;
}

// Nothing: of another campaign.
Result<std::optional<Dated>> dated_recording(const recording::FileSystem& files,
                                             const v1::Campaign& campaign, const Listed& one,
                                             const Clock& clock) {
  auto manifest = recording::read_manifest(files, one.folder);
  if (!manifest) return tl::make_unexpected(manifest.error());
  std::optional<Dated> out;
  if (*manifest && !is_of(**manifest, campaign)) return out;
  const Time start = *manifest ? began(one.started, **manifest, clock) : one.started;
  out = Dated{one.folder, start, std::move(*manifest)};
  return out;
}

// The recordings of a campaign that have a manifest.json, the newest first. Those that seem to
// begin after now come last: they were made before a clock was corrected.
Result<std::vector<Dated>> by_age(const recording::FileSystem& files, const v1::Campaign& campaign,
                                  const Clock& clock) {
  const auto listed = list_recordings(files, campaign.folder());
  if (!listed) return tl::make_unexpected(listed.error());
  std::vector<Dated> out;
  for (const Listed& one : *listed) {
    // What of it is there will do: a recording may be deleted in part.
    auto found = recording::read_whole_manifest(files, one.folder);
    if (!found || !*found || !is_of((*found)->manifest, campaign)) continue;
    v1::Manifest& manifest = (*found)->manifest;
    const Time start = began(one.started, manifest, clock);
    out.push_back({one.folder, start, std::move(manifest)});
  }
  const Time now = clock.now() + kSameSecond;
  std::sort(out.begin(), out.end(), [&](const Dated& a, const Dated& b) {
    return std::pair(a.began <= now, a.began) > std::pair(b.began <= now, b.began);
  });
  return out;
}

enum class Age { kYoung, kTooOld, kDoubtful };

// Whether a recording is older than `most` s, by clocks that can be trusted.
Age age_of(const Dated& one, double most, const Clock& clock) {
  const auto older = [&](std::chrono::nanoseconds age) {
    return std::chrono::duration<double>(age).count() > most;
  };
  if (!older(clock.now() - one.began)) return Age::kYoung;
  if (!clock.synchronised() || clock.boot_id().empty()) return Age::kDoubtful;
  const auto& notes = one.manifest->replicates();
  Time last = one.began;  // known to be right
  bool known = notes.empty();
  for (const v1::ReplicateNote& note : notes) {
    if (of_this_boot(note, clock) && !older(time_since(note, clock))) return Age::kDoubtful;
    // Recordings from before this was noted are taken at their word.
    const bool trusted = !note.has_clock_synchronised() || note.clock_synchronised();
    known = known || trusted || of_this_boot(note, clock);
    if (trusted) last = std::max(last, Time(std::chrono::nanoseconds(note.started_ns())));
  }
  if (!known) return Age::kDoubtful;
  return older(clock.now() - last) ? Age::kTooOld : Age::kYoung;
}

// manifest.json goes last: what is deleted in part is deleted the next time.
Result<void> remove_recording(recording::FileSystem& files, const fs::path& folder) {
  const auto names = files.list(folder);
  if (!names) return tl::make_unexpected(names.error());
  for (const std::string& name : *names) {
    if (name == recording::kManifestName) continue;
    auto done = name.ends_with('/')
                    ? recording::remove_tree(files, folder / name.substr(0, name.size() - 1))
                    : files.remove(folder / name);
    if (!done) return done;
  }
  return recording::remove_tree(files, folder);
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
                                                       const v1::Campaign& campaign,
                                                       const Clock& clock, const fs::path& known) {
  const auto listed = list_recordings(files, campaign.folder());
  if (!listed) return tl::make_unexpected(listed.error());
  std::optional<Dated> newest;
  bool agrees = false;  // with its name: what was named before began before
  for (const Listed& one : *listed) {
    if (agrees && one.folder != known) continue;
    auto dated = dated_recording(files, campaign, one, clock);
    if (!dated) return tl::make_unexpected(dated.error());
    if (!*dated || (*dated)->began > clock.now() + kSameSecond) continue;
    agrees = agrees || (*dated)->began == one.started;
    if (!newest || (*dated)->began > newest->began) newest = std::move(**dated);
  }
  if (!newest) return std::optional<FoundRecording>();
  const auto last = last_replicate(files, newest->folder);
  if (!last) return tl::make_unexpected(last.error());
  FoundRecording out{newest->folder, {newest->began, {}, *last}};
  if (newest->manifest) {
    const auto& notes = newest->manifest->replicates();
    out.state.notes.assign(notes.begin(), notes.end());
  }
  return std::optional(std::move(out));
}

Result<Tidied> tidy_recordings(recording::FileSystem& files, const v1::Campaign& campaign,
                               const Clock& clock) {
  const v1::CampaignRetention& keep = campaign.retention();
  Tidied out;
  if (keep.recordings() == 0 && !keep.has_age_s()) return out;
  const auto dated = by_age(files, campaign, clock);
  if (!dated) return tl::make_unexpected(dated.error());
  std::uint32_t kept = 0;
  for (const Dated& one : *dated) {
    const bool may_go = kept > 0 && one.manifest->closed();
    const bool too_many = may_go && keep.recordings() > 0 && kept >= keep.recordings();
    const Age age = may_go && keep.has_age_s() ? age_of(one, keep.age_s(), clock) : Age::kYoung;
    if (!too_many && age != Age::kTooOld) {
      ++kept;
      if (age == Age::kDoubtful) ++out.doubtful;
      continue;
    }
    if (auto done = remove_recording(files, one.folder); !done) {
      return fail(fmt::format("{}: retention deletes it, but it cannot be deleted: {}",
                              one.folder.string(), done.error().message));
    }
    out.removed.push_back(one.folder);
  }
  return out;
}

}  // namespace imunoise::acquire
