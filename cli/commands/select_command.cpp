#include "cli/commands/commands.h"
#include "cli/each_channel.h"
#include "cli/show.h"
#include "study/analysis/preflights.h"

namespace imunoise::cli {

int run(const SelectArguments& arguments) {
  const auto subjects = read_subjects(arguments.input, arguments.select.models);
  if (!subjects) return print_error(subjects.error());
  auto reports = each_channel<v1::ChoiceReports>(
      *subjects, "comparing models", [&](const study::Series& series, const Progress& progress) {
        return study::select_model(series, arguments.select, progress);
      });
  if (!reports) return print_error(reports.error());
  study::add_preflight(subjects->replicates, *reports);
  return show(*reports, arguments.show);
}

}  // namespace imunoise::cli
