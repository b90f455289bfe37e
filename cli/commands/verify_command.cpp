#include <fmt/format.h>

#include <cmath>

#include "cli/commands/commands.h"
#include "cli/output.h"
#include "core/support/counted.h"
#include "recording/store/verify/verify.h"
#include "study/report/json.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::cli {
namespace {

constexpr int kShownGaps = 5;

using report::count;

std::string number(double value) { return report::number(value, 3, report::Digits::kPlain); }

void describe_gaps(const v1::StreamIntegrity& stream, std::string& out) {
  if (stream.gap_count() == 0) {
    out += "  gaps       none\n";
    return;
  }
  out += fmt::format("  gaps       {}, {} samples lost, {} duplicates\n", count(stream.gap_count()),
                     count(stream.lost()), count(stream.duplicates()));
  for (int i = 0; i < stream.gaps_size() && i < kShownGaps; ++i) {
    const v1::Gap& gap = stream.gaps(i);
    out += fmt::format("             after sample {}: {} missing (seen by {})\n",
                       count(gap.after_sample()), gap.lost() > 0 ? count(gap.lost()) : "unknown",
                       gap.evidence());
  }
  if (stream.gap_count() > kShownGaps) out += "             ... (--json lists 100)\n";
}

void describe_channels(const v1::StreamIntegrity& stream, std::string& out) {
  for (const v1::ChannelIntegrity& channel : stream.channels()) {
    if (channel.saturated() > 0) {
      out += fmt::format("  {}: {} {} saturated\n", channel.name(), count(channel.saturated()),
                         plural(channel.saturated(), "sample"));
    }
    if (channel.stuck()) {
      out += fmt::format("  {}: stuck for {} samples from sample {}\n", channel.name(),
                         count(channel.longest_run()), count(channel.longest_run_at()));
    }
  }
}

void describe_stream(const v1::StreamIntegrity& stream, std::string& out) {
  out += fmt::format("\nreplicate {}, {}, stream {}\n", stream.replicate(), stream.device(),
                     stream.stream());
  out += fmt::format("  samples    {} received, {} stored", count(stream.received()),
                     count(stream.stored()));
  if (stream.in_journal() > 0)
    out += fmt::format(", {} in the journal", count(stream.in_journal()));
  for (const v1::RefusalCount& refusal : stream.refused()) {
    out += fmt::format(", {} refused ({}{})", count(refusal.samples()), refusal.reason(),
                       refusal.channel().empty() ? "" : " of " + refusal.channel());
  }
  out += "\n";
  describe_gaps(stream, out);
  if (stream.has_rate_hz()) {
    const double off = 1e6 * (stream.rate_hz() / stream.nominal_rate_hz() - 1.0);
    const double whole = std::round(off) + 0.0;  // no "-0"
    out += fmt::format(
        "  rate       {:.6g} Hz by the host's clock, {:+.0f} ppm of {:g} Hz; jitter {} s\n",
        stream.rate_hz(), whole, stream.nominal_rate_hz(), number(stream.jitter_s()));
  }
  describe_channels(stream, out);
}

std::string describe(const v1::VerifyReport& report) {
  std::string out = fmt::format("{}: {}, {} intact {}\n", report::clean_text(report.folder()),
                                report.sound() ? "sound" : "NOT SOUND", count(report.chunks()),
                                plural(report.chunks(), "chunk"));
  for (const v1::Defect& defect : report.defects()) {
    out += fmt::format("  {} {}\n", defect.repaired() ? "repaired:" : "defect:  ",
                       report::clean_text(defect.message()));
  }
  for (const v1::StreamIntegrity& stream : report.streams()) describe_stream(stream, out);
  return out;
}

}  // namespace

int run(const VerifyArguments& arguments) {
  recording::FileSystem& files = recording::posix_file_system();
  const auto report = std::filesystem::is_directory(arguments.path)
                          ? recording::verify_recording(files, arguments.path, arguments.repair)
                          : recording::verify_chunk(files, arguments.path);
  if (!report) return print_error(report.error());
  print(arguments.json ? report::to_json(*report) : describe(*report));
  return report->sound() ? 0 : 1;
}

}  // namespace imunoise::cli
