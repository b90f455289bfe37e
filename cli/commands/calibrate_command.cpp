#include <fmt/format.h>

#include <algorithm>

#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/interrupt.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "daemon/acquire/clock.h"
#include "study/calibration/calibrate.h"
#include "study/calibration/calibration_file.h"

namespace imunoise::cli {

namespace {

// A calibration without any model is no result.
int shown(const v1::Calibration& calibration, const ShowArguments& how) {
  const int status = show(calibration, how);
  const bool any = std::any_of(calibration.channels().begin(), calibration.channels().end(),
                               [](const auto& one) { return one.has_fit(); });
  return any ? status : std::max(status, 1);
}

int calibrate_plain_files(const CalibrateArguments& arguments,
                          const study::CalibrateOptions& options) {
  const Interrupt interrupt;
  const auto streams = read_streams(arguments.input);
  if (!streams) return print_error(streams.error());
  const auto done = [&] {
    ProgressLine line("calibrating");
    return study::calibrate_files(*streams, options, line.progress(interrupt.token()));
  }();
  return done ? shown(*done, arguments.show) : print_error(done.error());
}

}  // namespace

int run(const CalibrateArguments& arguments) {
  study::CalibrateOptions options = arguments.calibrate;
  options.made_ns = acquire::now_ns();
  const std::filesystem::path& folder = arguments.input.files.front();
  if (!is_recording(arguments.input)) return calibrate_plain_files(arguments, options);
  if (auto whole = check_for_recording(arguments.input.import); !whole)
    return print_error(whole.error());
  const Interrupt interrupt;
  recording::FileSystem& files = recording::posix_file_system();
  const auto done = [&] {
    ProgressLine line("calibrating");
    return study::calibrate(files, folder, options, line.progress(interrupt.token()));
  }();
  if (!done) return print_error(done.error());
  if (auto written = study::write_calibration(files, folder, *done); !written)
    return print_error(written.error());
  fmt::print(stderr, "wrote {}\n", (folder / study::kCalibrationName).string());
  return shown(*done, arguments.show);
}

}  // namespace imunoise::cli
