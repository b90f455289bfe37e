#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/show.h"
#include "study/analysis/preflights.h"
#include "study/deviation/compare.h"
#include "study/figure/svg.h"
#include "study/report/documents/datasheet_document.h"
#include "study/report/figures/datasheet_figure.h"

namespace imunoise::cli {
namespace {

Result<v1::DatasheetReports> compare(const DatasheetArguments& arguments) {
  v1::DatasheetReports out;
  const auto all = {&arguments.gyro, &arguments.accelerometer};
  if (arguments.input.files.empty()) {
    for (const auto* const printed : all)
      if (*printed)
        *out.add_channels() = study::printed_report(**printed, *arguments.input.import.rate);
    return out;
  }
  const auto replicates = read_input(arguments.input);
  if (!replicates) return tl::unexpected(replicates.error());
  for (const study::Series& series : all_series(*replicates)) {
    for (const auto* const printed : all) {
      if (!*printed || (*printed)->quantity != series.replicates.front().quantity()) continue;
      auto done = study::compare_with_datasheet(series, **printed, arguments.confidence);
      if (!done) return tl::unexpected(done.error());
      study::add_preflight(*replicates, *done->mutable_measured());
      *out.add_channels() = std::move(*done);
    }
  }
  if (out.channels().empty())
    return fail("no channel measures what the figures are of; give units with --unit");
  return out;
}

}  // namespace

int run(const DatasheetArguments& arguments) {
  const auto reports = compare(arguments);
  if (!reports) return print_error(reports.error());
  if (arguments.svg) {
    for (const v1::DatasheetReport& one : reports->channels()) {
      const auto out =
          reports->channels_size() > 1
              ? with_word(*arguments.svg,
                          one.channel().empty() ? one.unit().substr(0, 1) : one.channel())
              : *arguments.svg;
      if (auto done = write_file(out, figure::svg(report::datasheet_figure(one))); !done)
        return print_error(done.error());
      tell("wrote " + out.string() + "\n");
    }
  }
  return show(*reports, arguments.show);
}

}  // namespace imunoise::cli
