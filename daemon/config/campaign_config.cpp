#include "daemon/config/campaign_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <tuple>
#include <utility>

#include "core/effects/parse_full_model.h"
#include "core/support/counted.h"
#include "daemon/config/calendar.h"
#include "daemon/config/device_tables.h"
#include "daemon/config/quantity_text.h"

namespace imunoise::config {
namespace {

constexpr std::int64_t kMostReplicates = 100000;
constexpr std::int64_t kMostRepeats = 100;
constexpr double kShortest = 1.0;    // s, of a replicate
constexpr double kLeastEvery = 1.0;  // s
constexpr double kPatience = 60.0;   // s
constexpr std::uint64_t kReserve = 1'000'000'000;
constexpr std::uint32_t kRepeats = 1;
constexpr std::size_t kLargestFile = std::size_t{1} << 20U;

void read_calibration(const TomlEntry& entry, std::vector<Problem>& problems,
                      v1::CampaignCalibration& out) {
  TableReader reader(std::get<TomlTable>(entry.value.content), entry.place, "calibration",
                     problems);
  out.set_enabled(reader.flag("enabled").value_or(true));
  std::vector<FullModel> candidates;
  for (const PlacedText& one : reader.texts("models")) {
    const auto good = add_candidate(one.text, kAnyRate, "a calibration", candidates);
    if (!good) reader.complain_at(one.place, "models", good.error().message);
    out.add_models(one.text);
  }
  out.set_diagnose(reader.flag("diagnose").value_or(true));
  out.set_array(reader.flag("array").value_or(false));
  if (const auto text = reader.text("array_model")) {
    const auto model = parse_noise_model(*text, kAnyRate, grammar_of_arrays());
    if (!model) reader.complain("array_model", model.error().message);
    if (!out.array()) reader.complain("array_model", "has no effect without array = true");
    out.set_array_model(*text);
  }
  reader.finish();
}

void read_times(TableReader& reader, v1::Campaign& out) {
  if (const auto length = reader.duration("length")) {
    if (*length < kShortest) reader.complain("length", "is shorter than a second");
    out.set_length_s(*length);
  }
  reader.require("length", "length of each replicate, such as \"2 h\"");
  out.set_settling_s(reader.duration("settling").value_or(0.0));
  out.set_pause_s(reader.duration("pause").value_or(0.0));
  out.set_patience_s(reader.duration("patience").value_or(kPatience));
}

void read_schedule(const TomlEntry& entry, std::vector<Problem>& problems,
                   v1::CampaignSchedule& out) {
  TableReader reader(std::get<TomlTable>(entry.value.content), entry.place, "schedule", problems);
  if (const auto every = reader.duration("every")) {
    if (*every < kLeastEvery) reader.complain("every", "is less than a second");
    out.set_every_s(*every);
  }
  if (const auto calendar = reader.text("calendar")) {
    if (!may_be_calendar(*calendar)) {
      reader.complain(
          "calendar",
          "is not a systemd calendar expression; check it with systemd-analyze calendar");
    }
    out.set_calendar(*calendar);
  }
  if (reader.has("every") && reader.has("calendar")) {
    reader.complain("calendar", "conflicts with 'every'; give only one");
  }
  if (!reader.has("every") && !reader.has("calendar")) {
    reader.complain("",
                    "is empty; give every = \"6 h\" or calendar = \"Mon 02:00\", or remove "
                    "the table to record once, now");
  }
  reader.finish();
}

void read_retention(const TomlEntry& entry, std::vector<Problem>& problems,
                    v1::CampaignRetention& out) {
  TableReader reader(std::get<TomlTable>(entry.value.content), entry.place, "retention", problems);
  if (const auto recordings = reader.integer("recordings", 1, kMostReplicates)) {
    out.set_recordings(static_cast<std::uint32_t>(*recordings));
  }
  if (const auto age = reader.duration("age")) {
    if (*age <= 0.0) reader.complain("age", "is zero; give the greatest age of a recording");
    out.set_age_s(*age);
  }
  reader.finish();
}

void read_stillness(const TomlEntry& entry, std::vector<Problem>& problems,
                    v1::CampaignStillness& out) {
  TableReader reader(std::get<TomlTable>(entry.value.content), entry.place, "stillness", problems);
  out.set_repeat_disturbed(reader.flag("repeat_disturbed").value_or(false));
  out.set_repeats(
      static_cast<std::uint32_t>(reader.integer("repeats", 1, kMostRepeats).value_or(kRepeats)));
  if (reader.has("repeats") && !out.repeat_disturbed()) {
    reader.complain("repeats", "has no effect without repeat_disturbed = true");
  }
  reader.finish();
}

void check_rhythm(TableReader& reader, const v1::Campaign& campaign) {
  if (!campaign.schedule().has_every_s() || campaign.length_s() <= 0.0) return;
  const double replicates = campaign.replicates();
  const double needed = campaign.settling_s() + replicates * campaign.length_s() +
                        (replicates - 1.0) * campaign.pause_s();
  if (needed <= campaign.schedule().every_s()) return;
  reader.complain(
      "schedule",
      fmt::format("a recording takes {} (settling, {}, pauses), longer than every = {}; "
                  "record less, or less often",
                  print_duration(needed), counted(campaign.replicates(), "replicate"),
                  print_duration(campaign.schedule().every_s())));
}

void read_all(TableReader& reader, const drivers::Drivers& drivers, CampaignConfig& out) {
  v1::Campaign& campaign = out.campaign;
  if (const auto name = reader.text("name")) {
    if (const auto good = check_name(*name); !good) reader.complain("name", good.error().message);
    campaign.set_name(*name);
  }
  reader.require("name", "name of the campaign, such as \"bench-3\"");
  campaign.set_folder(reader.text("folder").value_or(""));
  reader.require("folder", "folder of the recordings, such as \"recordings/bench-3\"");
  const auto replicates = reader.integer("replicates", 1, kMostReplicates);
  campaign.set_replicates(static_cast<std::uint32_t>(replicates.value_or(1)));
  read_times(reader, campaign);
  campaign.set_reserve_bytes(reader.bytes("reserve").value_or(kReserve));
  campaign.set_wire(reader.flag("wire").value_or(false));
  campaign.mutable_stillness()->set_repeats(kRepeats);
  campaign.mutable_calibration()->set_enabled(true);
  campaign.mutable_calibration()->set_diagnose(true);
  if (const auto* const entry = reader.table("calibration")) {
    read_calibration(*entry, out.problems, *campaign.mutable_calibration());
  }
  if (const auto* const entry = reader.table("schedule")) {
    read_schedule(*entry, out.problems, *campaign.mutable_schedule());
  }
  if (const auto* const entry = reader.table("retention")) {
    read_retention(*entry, out.problems, *campaign.mutable_retention());
  }
  if (const auto* const entry = reader.table("stillness")) {
    read_stillness(*entry, out.problems, *campaign.mutable_stillness());
  }
  read_devices(reader, drivers, out.problems, campaign);
  check_rhythm(reader, campaign);
  reader.finish();
}

}  // namespace

CampaignConfig parse_campaign(std::string_view text, const drivers::Drivers& drivers) {
  CampaignConfig out;
  const auto document = parse_toml(text);
  if (const auto* const problem = std::get_if<Problem>(&document)) {
    out.problems.push_back(*problem);
    return out;
  }
  TableReader reader(std::get<TomlTable>(document), {}, "", out.problems);
  read_all(reader, drivers, out);
  std::stable_sort(
      out.problems.begin(), out.problems.end(), [](const Problem& a, const Problem& b) {
        return std::tie(a.place.line, a.place.column) < std::tie(b.place.line, b.place.column);
      });
  return out;
}

Result<CampaignConfig> read_campaign(const std::filesystem::path& file,
                                     const drivers::Drivers& drivers) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::string text(kLargestFile + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream.eof() && stream.fail()) {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): glibc's has no shared state for known errors.
    return fail(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
  }
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > kLargestFile) {
    return fail(fmt::format("{}: is larger than 1 MiB; is it a campaign?", file.string()));
  }
  return parse_campaign(text, drivers);
}

}  // namespace imunoise::config
