#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "cli/commands/commands.h"
#include "cli/output.h"
#include "imunoise/v1/service.pb.h"
#include "study/report/documents/document.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::cli {
namespace {

using report::Digits;

constexpr std::size_t kTimes = 6;  // columns of averaging times

// Averaging times of a device's channels for the columns: every k-th one, the longest among them.
std::vector<double> columns(const v1::LiveDevice& device) {
  std::vector<double> all;
  for (const v1::LiveChannel& one : device.channels()) {
    for (const v1::LiveScale& scale : one.scales()) all.push_back(scale.tau_s());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<double> out;
  const std::size_t step = (all.size() + kTimes - 1) / kTimes;
  for (std::size_t i = all.size(); i > 0; i -= std::min(i, step))
    out.insert(out.begin(), all[i - 1]);
  return out;
}

std::string cell(const v1::LiveChannel& channel, double tau) {
  const auto found = std::find_if(channel.scales().begin(), channel.scales().end(),
                                  [&](const v1::LiveScale& one) { return one.tau_s() == tau; });
  if (found == channel.scales().end()) return "";
  const std::string value = report::number(found->deviation(), 3, Digits::kPlain);
  // Too few so far: how well it is known, and for how much longer to record.
  return found->enough_in_s() > 0.0 && found->deviation() > 0.0
             ? fmt::format("{} ±{:.0f} % (+{})", value,
                           50.0 * (found->upper() - found->lower()) / found->deviation(),
                           report::duration(found->enough_in_s()))
             : value;
}

report::Table deviations(const v1::LiveDevice& device) {
  report::Table out{
      "Wavelet deviation (± half of its interval, + the time until it is known within a factor of "
      "two)",
      {"channel", "unit"},
      {}};
  const std::vector<double> times = columns(device);
  for (const double tau : times) out.head.push_back(report::duration(tau));
  for (const v1::LiveChannel& one : device.channels()) {
    std::vector<std::string> row{one.channel(), one.units()};
    for (const double tau : times) row.push_back(cell(one, tau));
    out.rows.push_back(std::move(row));
  }
  return out;
}

report::Table streams(const v1::LiveDevice& device) {
  report::Table out{
      "Streams",
      {"stream", "rate", "nominal", "samples", "missing", "gaps", "refused", "temperature"},
      {}};
  const auto hertz = [](double rate) { return report::number(rate, 4, Digits::kPlain) + " Hz"; };
  for (const v1::LiveStream& one : device.streams())
    out.rows.push_back(
        {one.stream(), one.has_rate_hz() ? hertz(one.rate_hz()) : "", hertz(one.nominal_hz()),
         report::count(one.samples()), report::count(one.missing()), report::count(one.gaps()),
         report::count(one.refused()),
         one.has_temperature_k() ? fmt::format("{:.1f} °C", one.temperature_k() - 273.15) : ""});
  return out;
}

std::string last_minute(const v1::RangeChannel& channel) {
  const float low = *std::min_element(channel.lower().begin(), channel.lower().end());
  const float high = *std::max_element(channel.upper().begin(), channel.upper().end());
  return fmt::format("In the last minute, {} lay between {} and {} {}.", channel.channel(),
                     report::number(low, 3, Digits::kPlain),
                     report::number(high, 3, Digits::kPlain), channel.units());
}

// " Averaging times up to 2.5 s are known."
std::string sentence(std::string text) {
  if (text.empty()) return text;
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return " " + text + (text.ends_with('.') ? "" : ".");
}

std::string facts(const v1::LiveDevice& device) {
  return fmt::format("{} received · {} stored · {} discarded · {} refused · {} gaps",
                     report::count(device.received()), report::count(device.stored()),
                     report::count(device.discarded()), report::count(device.refused()),
                     report::count(device.gaps()));
}

report::Section section(const v1::LiveReplicate& replicate, const v1::LiveDevice& device) {
  report::Section out;
  out.title = fmt::format("{} {}", replicate.campaign(), device.device());
  out.facts = facts(device);
  out.summary =
      fmt::format("Replicate {} of {}: {}{} recorded.{}", replicate.replicate(),
                  replicate.recording(), report::duration(device.elapsed_s()),
                  replicate.length_s() > 0.0 ? " of " + report::duration(replicate.length_s()) : "",
                  sentence(device.outlook()));
  if (device.last_minute().lower_size() > 0 && device.last_minute().upper_size() > 0)
    out.summary += " " + last_minute(device.last_minute());
  if (device.streams_size() > 0) out.tables.push_back(streams(device));
  if (device.channels_size() > 0) out.tables.push_back(deviations(device));
  if (device.last_sample_ns() > 0)
    out.summary += " The latest sample came at " + report::minute(device.last_sample_ns()) + ".";
  if (!device.disk_trouble().empty()) out.notes.push_back(device.disk_trouble());
  for (const v1::LiveWarning& one : device.warnings()) out.notes.push_back(one.sentence());
  if (device.has_past_warning())
    out.notes.push_back(fmt::format("{} (over since {})", device.past_warning().sentence(),
                                    report::minute(device.past_warning().since_ns())));
  out.mood = out.notes.empty() ? report::Mood::kGood : report::Mood::kDoubtful;
  return out;
}

std::string live_text(const v1::LiveList& list) {
  report::Document out{"live", {}};
  for (const v1::LiveReplicate& replicate : list.replicates()) {
    for (const v1::LiveDevice& device : replicate.devices())
      out.sections.push_back(section(replicate, device));
  }
  return out.sections.empty() ? "no replicate is being recorded\n"
                              : report::text(out, terminal_style());
}

}  // namespace

int run(const LiveArguments& arguments) {
  auto client = DaemonClient::open(arguments.daemon);
  if (!client) return print_error(client.error());
  const auto json = client->get("/v1/live");
  if (!json) return print_error(json.error());
  v1::LiveList list;
  if (auto read = read_answer(*json, list); !read) return print_error(read.error());
  print(arguments.json ? *json : live_text(list));
  return 0;
}

}  // namespace imunoise::cli
