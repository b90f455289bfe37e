#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/progress_line.h"
#include "cli/show.h"

namespace imunoise::cli {

int run(const SelectArguments& arguments) {
  const auto subjects = read_subjects(arguments.input, arguments.select.models);
  if (!subjects) return print_error(subjects.error());
  v1::ChoiceReports reports;
  for (const study::Series& series : subjects->series) {
    ProgressLine line(series.channel);
    const auto done = study::select_model(series, arguments.select, line.progress());
    if (!done) return print_error(done.error());
    *reports.add_channels() = *done;
  }
  return show(reports, arguments.show);
}

}  // namespace imunoise::cli
