#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/progress_line.h"
#include "cli/show.h"

namespace imunoise::cli {

int run(const DynamicArguments& arguments) {
  const auto recordings = read_input(arguments.input);
  if (!recordings) return print_error(recordings.error());
  ProgressLine line("dynamic");
  const auto done = study::dynamic_channels(*recordings, arguments.dynamic, line.progress());
  if (!done) return print_error(done.error());
  return show(*done, arguments.show);
}

}  // namespace imunoise::cli
