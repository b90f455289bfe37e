#include <fmt/format.h>

#include <mutex>

#include "cli/commands/commands.h"
#include "cli/interrupt.h"
#include "cli/output.h"
#include "cli/progress_line.h"
#include "core/support/counted.h"
#include "core/support/utf8.h"
#include "daemon/acquire/record_replicate.h"
#include "daemon/process/ignored_signals.h"
#include "drivers/host/load.h"
#include "recording/store/format/layout.h"
#include "study/report/json.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::cli {
namespace {

// One more than the highest replicate that the folder holds.
std::uint32_t next_replicate(const std::filesystem::path& folder) {
  std::uint32_t last = 0;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const auto number = recording::replicate_of(entry.path().filename().string());
    last = std::max(last, number.value_or(0));
  }
  return last + 1;
}

// The drivers of the devices that were asked for. Devices of one driver are numbered from the
// second.
Result<std::vector<acquire::DevicePlan>> plans_of(const RecordArguments& arguments) {
  const drivers::Drivers known =
      drivers::load_drivers(drivers::driver_folders(arguments.driver_folders));
  std::vector<acquire::DevicePlan> out;
  for (const DeviceArguments& one : arguments.devices) {
    const auto driver = known.find(one.driver);
    if (!driver) return tl::make_unexpected(driver.error());
    const auto before = std::count_if(out.begin(), out.end(), [&](const auto& plan) {
      return plan.driver.info.name == one.driver;
    });
    std::string name = one.driver + (before > 0 ? fmt::format("-{}", before + 1) : "");
    out.push_back({std::move(name), **driver, {}});
    for (const std::string& text : one.options) {
      auto option = drivers::parse_option(text);
      if (!option) return tl::make_unexpected(option.error());
      out.back().options.push_back(std::move(*option));
    }
  }
  return out;
}

void add(const acquire::DeviceOutcome& outcome, std::uint32_t replicate, v1::RecordReport& report) {
  for (std::size_t s = 0; s < outcome.streams.size(); ++s) {
    const recording::StreamCounts& counts = outcome.streams[s];
    v1::RecordedTally& to = *report.add_streams();
    to.set_replicate(replicate);
    to.set_device(outcome.device.name());
    to.set_stream(outcome.device.streams(static_cast<int>(s)).name());
    to.set_received(counts.received);
    to.set_stored(counts.stored);
    for (const recording::Refusal& refusal : counts.refused) {
      *to.add_refused() = recording::to_message(refusal);
    }
    to.set_disconnections(outcome.disconnections);
    if (outcome.failure) to.set_failure(outcome.failure->message);
  }
}

using report::count;

std::string describe(const v1::RecordReport& report) {
  std::string out = fmt::format("recorded into {}\n", report::clean_text(report.folder()));
  for (const v1::RecordedTally& one : report.streams()) {
    out += fmt::format("  replicate {}, {}, {}: {} samples stored of {}", one.replicate(),
                       one.device(), one.stream(), count(one.stored()), count(one.received()));
    for (const v1::RefusalCount& refusal : one.refused()) {
      out += fmt::format(", {} refused ({}{})", count(refusal.samples()), refusal.reason(),
                         refusal.channel().empty() ? "" : " of " + refusal.channel());
    }
    if (one.disconnections() > 0)
      out += fmt::format(", unplugged {}", counted(one.disconnections(), "time"));
    if (!one.failure().empty()) {
      out += fmt::format("\n    given up: {}", report::clean_text(one.failure()));
    }
    out += "\n";
  }
  return out + fmt::format("Check it with: imunoise verify {}\n",
                           in_shell(report::clean_text(report.folder())));
}

}  // namespace

int run(const RecordArguments& arguments) {
  const Interrupt interrupt;
  const process::IgnoredSignals ignored;
  if (const std::string folder = arguments.folder.string(); !is_utf8(folder)) {
    return print_error({repaired_utf8(folder) +
                        ": the name is not UTF-8, which a manifest cannot hold; name another "
                        "folder"});
  }
  auto devices = plans_of(arguments);
  if (!devices) return print_error(devices.error());
  const std::uint32_t first =
      arguments.replicate ? *arguments.replicate : next_replicate(arguments.folder);
  v1::RecordReport report;
  report.set_folder(arguments.folder.string());
  std::mutex notes;
  const auto note = [&](const std::string& device, std::string_view text) {
    const std::lock_guard lock(notes);
    tell(fmt::format("{}: {}\n", device, report::clean_text(text)));
  };
  bool failed = false;
  for (std::uint32_t k = 0; k < arguments.replicates && !interrupt.token().stop_requested(); ++k) {
    ProgressLine line(fmt::format("replicate {}", first + k));
    acquire::ReplicatePlan plan;
    plan.folder = arguments.folder;
    plan.replicate = first + k;
    plan.devices = *devices;
    plan.duration = arguments.duration;
    plan.wire = arguments.wire;
    const auto outcome = acquire::record_replicate(recording::posix_file_system(), plan, note,
                                                   line.progress(interrupt.token()));
    if (!outcome) return print_error(outcome.error());
    for (const acquire::DeviceOutcome& one : outcome->devices) {
      add(one, first + k, report);
      failed = failed || one.failure.has_value();
    }
    if (outcome->note.state() != v1::complete && !interrupt.token().stop_requested()) {
      fmt::print(stderr, "replicate {} is interrupted: {}\n", first + k,
                 report::clean_text(outcome->note.reason()));
      failed = true;
    }
  }
  if (!try_print(arguments.json ? report::to_json(report) : describe(report))) {
    return print_error(
        {"standard output takes no report; the recording is closed: see imunoise "
         "verify " +
         arguments.folder.string()});
  }
  return failed ? 1 : 0;
}

}  // namespace imunoise::cli
