#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/output.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "study/deviation/deviations.h"
#include "study/figure/svg.h"
#include "study/report/figures/deviation_figure.h"
#include "study/report/json.h"

namespace imunoise::cli {
namespace {

int show_deviations(const std::vector<recording::Replicate>& replicates,
                    const WvArguments& arguments) {
  v1::DeviationReports reports;
  const std::vector<study::Series> all = all_series(replicates);
  for (const study::Series& series : all) {
    const auto done = study::deviations(series, *arguments.deviation, arguments.measure.confidence);
    if (!done) return print_error(done.error());
    *reports.add_channels() = *done;
    if (!arguments.svg) continue;
    const auto out = all.size() > 1 ? with_word(*arguments.svg, series.channel) : *arguments.svg;
    if (auto written = write_file(out, figure::svg(report::deviation_figure(*done))); !written)
      return print_error(written.error());
    tell("wrote " + out.string() + "\n");
  }
  return show(reports, arguments.show);
}

}  // namespace

int run(const WvArguments& arguments) {
  const auto replicates = read_input(arguments.input);
  if (!replicates) return print_error(replicates.error());
  if (arguments.deviation) return show_deviations(*replicates, arguments);
  v1::WaveletVarianceReports reports;
  for (const study::Series& series : all_series(*replicates)) {
    ProgressLine line(series.channel);
    const auto measured = study::measure(series, arguments.measure, line.progress());
    if (!measured) return print_error(measured.error());
    *reports.add_channels() = study::wavelet_report(series, *measured);
  }
  if (arguments.show.json) {
    const bool single = reports.channels_size() == 1;
    print(single ? report::to_json(reports.channels(0)) : report::to_json(reports));
    return 0;
  }
  for (const v1::WaveletVarianceReport& one : reports.channels()) {
    print(report::wv_text(one, terminal_style()));
  }
  return 0;
}

}  // namespace imunoise::cli
