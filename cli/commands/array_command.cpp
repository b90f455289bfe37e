#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "study/analysis/preflights.h"

namespace imunoise::cli {

int run(const ArrayArguments& arguments) {
  const auto replicates = read_together(arguments.input);
  if (!replicates) return print_error(replicates.error());
  auto done = [&] {
    ProgressLine line("fitting the array");
    return study::array_series(all_series(*replicates), arguments.array, line.progress());
  }();
  if (!done) return print_error(done.error());
  study::add_preflight(*replicates, *done);
  return show(*done, arguments.show);
}

}  // namespace imunoise::cli
