#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "study/analysis/preflights.h"

namespace imunoise::cli {

int run(const FaultsArguments& arguments) {
  const auto replicates = read_together(arguments.input);
  if (!replicates) return print_error(replicates.error());
  std::vector<recording::Replicate> good;
  if (!arguments.training.files.empty()) {
    auto read = read_together(arguments.training);
    if (!read) return print_error(read.error());
    good = std::move(*read);
  }
  auto done = [&] {
    ProgressLine line("searching");
    return study::fault_series(all_series(*replicates),
                               good.empty() ? std::vector<study::Series>{} : all_series(good),
                               arguments.faults, line.progress());
  }();
  if (!done) return print_error(done.error());
  study::add_preflight(*replicates, *done);
  return show(*done, arguments.show);
}

}  // namespace imunoise::cli
