#include <fmt/format.h>

#include "cli/commands/commands.h"
#include "cli/interrupt.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "daemon/acquire/clock.h"
#include "study/calibration/calibrate.h"
#include "study/calibration/calibration_file.h"

namespace imunoise::cli {

int run(const CalibrateArguments& arguments) {
  const Interrupt interrupt;
  recording::FileSystem& files = recording::posix_file_system();
  study::CalibrateOptions options = arguments.calibrate;
  options.made_ns = acquire::now_ns();
  const auto done = [&] {
    ProgressLine line("calibrating");
    return study::calibrate(files, arguments.folder, options, line.progress(interrupt.token()));
  }();
  if (!done) return print_error(done.error());
  if (auto written = study::write_calibration(files, arguments.folder, *done); !written)
    return print_error(written.error());
  fmt::print(stderr, "wrote {}\n", (arguments.folder / study::kCalibrationName).string());
  return show(*done, arguments.show);
}

}  // namespace imunoise::cli
