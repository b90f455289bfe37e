#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "study/analysis/preflights.h"

namespace imunoise::cli {
namespace {

Result<v1::ChoiceReports> reports_of(const Subjects& subjects, const SelectArguments& arguments) {
  v1::ChoiceReports out;
  ProgressLine line("comparing models");
  for (std::size_t i = 0; i < subjects.series.size(); ++i) {
    const study::Series& series = subjects.series[i];
    const auto done = study::select_model(series, arguments.select,
                                          line.part(i, subjects.series.size(), series.channel));
    if (!done) return tl::unexpected(done.error());
    *out.add_channels() = *done;
  }
  return out;
}

}  // namespace

int run(const SelectArguments& arguments) {
  const auto subjects = read_subjects(arguments.input, arguments.select.models);
  if (!subjects) return print_error(subjects.error());
  auto reports = reports_of(*subjects, arguments);
  if (!reports) return print_error(reports.error());
  study::add_preflight(subjects->replicates, *reports);
  return show(*reports, arguments.show);
}

}  // namespace imunoise::cli
