#include <algorithm>

#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "study/analysis/arrays/regressors.h"
#include "study/analysis/preflights.h"

namespace imunoise::cli {

int run(const MixedArguments& arguments) {
  InputArguments input = arguments.input;
  if (std::vector<std::string>& wanted = input.import.channels; !wanted.empty()) {
    for (std::string& name : study::channels_of(arguments.mixed.regressors)) {
      if (std::find(wanted.begin(), wanted.end(), name) == wanted.end())
        wanted.push_back(std::move(name));
    }
  }
  const auto replicates = read_together(input);
  if (!replicates) return print_error(replicates.error());
  auto done = [&] {
    ProgressLine line("fitting");
    return study::mixed_series(all_series(*replicates), arguments.mixed, line.progress());
  }();
  if (!done) return print_error(done.error());
  study::add_preflight(*replicates, *done);
  return show(*done, arguments.show);
}

}  // namespace imunoise::cli
