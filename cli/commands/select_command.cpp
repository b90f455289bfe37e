#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/progress_line.h"
#include "cli/show.h"

namespace imunoise::cli {

int run(const SelectArguments& arguments) {
  const auto replicates = read_input(arguments.input);
  if (!replicates) return print_error(replicates.error());
  v1::ChoiceReports reports;
  for (const study::Series& series : all_series(*replicates)) {
    ProgressLine line(series.channel);
    const auto done = study::select_model(series, arguments.select, line.progress());
    if (!done) return print_error(done.error());
    *reports.add_channels() = *done;
  }
  return show(reports, arguments.show);
}

}  // namespace imunoise::cli
