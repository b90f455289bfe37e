#include <fmt/format.h>

#include <thread>

#include "cli/commands/commands.h"
#include "cli/interrupt.h"
#include "cli/output.h"

namespace imunoise::cli {

int run(const EmulateArguments& arguments) {
  using Clock = std::chrono::steady_clock;
  const Interrupt interrupt;
  const auto device = emulator::serve(arguments.plan);
  if (!device) return print_error(device.error());
  print(fmt::format(
      "emulating, seed {}; record it with\n  imunoise record FOLDER --device \"{}\" --duration 10\n"
      "Ctrl-C ends it.\n",
      arguments.plan.source.seed, (*device)->device_text()));
  std::fflush(stdout);  // the program that started it waits for these lines
  const Clock::time_point begin = Clock::now();
  const auto over = [&] {
    return interrupt.token().stop_requested() ||
           (arguments.duration && Clock::now() - begin >= *arguments.duration);
  };
  while (!over()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  print(fmt::format("{} messages\n", (*device)->messages()));
  return 0;
}

}  // namespace imunoise::cli
