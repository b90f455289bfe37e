#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "study/analysis/preflights.h"

namespace imunoise::cli {

int run(const DynamicArguments& arguments) {
  const auto recordings = read_input(arguments.input);
  if (!recordings) return print_error(recordings.error());
  auto done = [&] {
    ProgressLine line("fitting");
    return study::dynamic_channels(*recordings, arguments.dynamic, line.progress());
  }();
  if (!done) return print_error(done.error());
  study::add_preflight(*recordings, *done);
  return show(*done, arguments.show);
}

}  // namespace imunoise::cli
