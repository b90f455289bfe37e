#include <fmt/format.h>

#include <algorithm>

#include "cli/commands/commands.h"
#include "cli/each_channel.h"
#include "cli/output.h"
#include "study/analysis/preflights.h"
#include "study/figure/svg.h"
#include "study/report/figures/budget_figure.h"
#include "study/report/html/fit_page.h"
#include "study/report/json.h"

namespace imunoise::cli {
namespace {

// One picture a channel: OUT.svg, or OUT_channel.svg when there are several.
Result<void> write_pictures(const v1::FitReports& reports, const std::filesystem::path& path) {
  for (const v1::FitReport& one : reports.channels()) {
    const std::filesystem::path out =
        reports.channels_size() > 1 ? with_word(path, one.channel()) : path;
    if (auto done = write_file(out, figure::svg(report::budget_figure(one))); !done) return done;
    fmt::print(stderr, "wrote {}\n", out.string());
  }
  return {};
}

int status_of(const v1::FitReports& reports, const FitArguments& arguments) {
  constexpr int kMisfit = 3;
  const bool misfit =
      std::any_of(reports.channels().begin(), reports.channels().end(),
                  [](const v1::FitReport& one) { return one.verdict() == v1::does_not_fit; });
  return misfit && arguments.fail_if_misfit ? kMisfit : 0;
}

}  // namespace

int run(const FitArguments& arguments) {
  const auto subjects = read_subjects(arguments.input, named_model(arguments.fit.model));
  if (!subjects) return print_error(subjects.error());
  auto reports = each_channel<v1::FitReports>(
      *subjects, "fitting", [&](const study::Series& series, const Progress& progress) {
        return study::fit_series(series, arguments.fit, progress);
      });
  if (!reports) return print_error(reports.error());
  study::add_preflight(subjects->replicates, *reports);
  if (arguments.report) {
    if (auto done = write_report(*arguments.report, report::html_page(*reports)); !done)
      return print_error(done.error());
  }
  if (arguments.svg) {
    if (auto done = write_pictures(*reports, *arguments.svg); !done)
      return print_error(done.error());
  }
  if (arguments.json) {
    const bool single = reports->channels_size() == 1;
    print(single ? report::to_json(reports->channels(0)) : report::to_json(*reports));
    return status_of(*reports, arguments);
  }
  for (const v1::FitReport& one : reports->channels())
    print(report::fit_text(one, terminal_style()));
  return status_of(*reports, arguments);
}

}  // namespace imunoise::cli
