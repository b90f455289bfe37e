#include <fmt/ranges.h>

#include <algorithm>

#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/output.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "recording/import/table/names.h"
#include "study/analysis/preflights.h"
#include "study/calibration/calibrate.h"
#include "study/figure/svg.h"
#include "study/report/figures/diagnosis_pictures.h"

namespace imunoise::cli {
namespace {

// Angular rates and accelerations; where there are none, what the first channel measures.
bool by_default(const recording::Channel& one, const recording::Replicate& in) {
  const auto inertial = [](const recording::Channel& channel) {
    return of_inertia(channel.unit.quantity);
  };
  if (one.interpolated) return false;
  if (std::any_of(in.channels.begin(), in.channels.end(), inertial)) return inertial(one);
  return one.unit.quantity == in.channels[0].unit.quantity;
}

// The numbers of the channels to be diagnosed.
Result<std::vector<std::size_t>> subjects(const recording::Replicate& first,
                                          const std::vector<std::string>& wanted) {
  std::vector<std::size_t> out;
  for (const std::string& name : wanted) {
    const auto found = study::channel_called(name, first);
    if (!found) return tl::unexpected(found.error());
    if (first.channels[*found].interpolated)
      return fail(name +
                  ": is of another stream than the channels before it; diagnose it by itself");
    const bool several = first.channels[*found].name != name;  // a pattern
    for (std::size_t c = *found; c < (several ? first.channels.size() : *found + 1); ++c) {
      if (c == *found || recording::matches(name, first.channels[c].name)) out.push_back(c);
    }
  }
  if (!out.empty()) return out;
  for (std::size_t c = 0; c < first.channels.size(); ++c) {
    if (by_default(first.channels[c], first)) out.push_back(c);
  }
  return out;
}

// Names the axes without a unit, which are not diagnosed.
void tell_left_out(const std::vector<recording::Replicate>& replicates,
                   const std::vector<std::size_t>& channels) {
  std::vector<std::string> names = study::axes_without_unit({replicates});
  for (const std::size_t c : channels) std::erase(names, replicates.front().channels[c].name);
  if (!names.empty())
    tell(
        fmt::format("{}: not diagnosed, because no unit is stated; give one with --unit, or name "
                    "the channels with --channel\n",
                    fmt::join(names, ", ")));
}

Result<v1::DiagnosisReports> reports_of(const std::vector<recording::Replicate>& replicates,
                                        const std::vector<std::size_t>& channels,
                                        const DiagnoseArguments& arguments) {
  v1::DiagnosisReports out;
  ProgressLine line("diagnosing");
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const auto done = study::diagnose_series(
        replicates, channels[i], arguments.diagnose,
        line.part(i, channels.size(), replicates.front().channels[channels[i]].name));
    if (!done) return tl::unexpected(done.error());
    *out.add_channels() = *done;
  }
  return out;
}

Result<void> write_pictures(const v1::DiagnosisReports& reports,
                            const std::filesystem::path& path) {
  for (const v1::DiagnosisReport& one : reports.channels()) {
    const auto base = reports.channels_size() > 1 ? with_word(path, one.channel()) : path;
    for (const report::Picture& picture : report::pictures(one)) {
      const std::filesystem::path out = with_word(base, picture.word);
      if (auto done = write_file(out, figure::svg(picture.figure)); !done) return done;
      fmt::print(stderr, "wrote {}\n", out.string());
    }
  }
  return {};
}

}  // namespace

int run(const DiagnoseArguments& arguments) {
  const auto replicates = read_with_witnesses(arguments.input, arguments.diagnose.witnesses);
  if (!replicates) return print_error(replicates.error());
  const auto channels = subjects(replicates->front(), arguments.channels);
  if (!channels) return print_error(channels.error());
  if (arguments.channels.empty()) tell_left_out(*replicates, *channels);
  auto done = reports_of(*replicates, *channels, arguments);
  if (!done) return print_error(done.error());
  v1::DiagnosisReports& reports = *done;
  study::add_preflight(*replicates, reports);
  if (arguments.svg) {
    if (auto written = write_pictures(reports, *arguments.svg); !written)
      return print_error(written.error());
  }
  return show(reports, arguments.show);
}

}  // namespace imunoise::cli
