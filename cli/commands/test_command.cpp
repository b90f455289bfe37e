#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/progress_line.h"
#include "cli/show.h"

namespace imunoise::cli {

int run(const TestArguments& arguments) {
  const auto subjects = read_subjects(arguments.input, named_model(arguments.test.model));
  if (!subjects) return print_error(subjects.error());
  v1::StationarityReports reports;
  for (const study::Series& series : subjects->series) {
    ProgressLine line(series.channel);
    const auto done = study::test_series(series, arguments.test, line.progress());
    if (!done) return print_error(done.error());
    *reports.add_channels() = *done;
  }
  return show(reports, arguments.show);
}

}  // namespace imunoise::cli
