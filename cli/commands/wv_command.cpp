#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/output.h"
#include "cli/progress_line.h"
#include "study/report/json.h"

namespace imunoise::cli {

int run(const WvArguments& arguments) {
  const auto replicates = read_input(arguments.input);
  if (!replicates) return print_error(replicates.error());
  v1::WaveletVarianceReports reports;
  for (const study::Series& series : all_series(*replicates)) {
    ProgressLine line(series.channel);
    const auto measured = study::measure(series, arguments.measure, line.progress());
    if (!measured) return print_error(measured.error());
    *reports.add_channels() = study::wavelet_report(series, *measured);
  }
  if (arguments.json) {
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
