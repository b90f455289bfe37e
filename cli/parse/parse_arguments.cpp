#include <CLI/CLI.hpp>

#include "cli/arguments.h"
#include "cli/parse/commands.h"

namespace imunoise::cli {
namespace {

constexpr const char* kExamples = R"help(
Examples:
  imunoise fit run?.h5 --channel gyro_x                  a noise model from all replicates
  imunoise fit run?.h5 --model "2*AR1 + WN + RW" --report gyro.html --svg gyro.svg
  imunoise select run?.h5 --model "2*AR1 + WN + RW"      which of its sub-models predicts best
  imunoise test run?.h5 --model "AR1 + WN + RW"          do replicates differ, or does it not fit?
  imunoise wv run1.csv --rate 100 --unit deg/s           the measured wavelet variance
  imunoise simulate --model "WN(sigma2=1e-6) + RW(gamma2=1e-14)" --rate 100 \
      --samples 360000 --replicates 6 --seed 1 --out run.h5
  imunoise decode --format xbus capture.bin              what a device's bytes say
  imunoise verify recordings/monday                      is the recording intact?
  imunoise calibrate recordings/monday                   all of its channels at once
  imunoise history recordings --device 0042              this device over months; does it drift?
  imunoise status --follow                               what imunoised records, and how long still
  imunoise batch run nightly --engine slurm              many recordings or simulations at once
  imunoise emulate --device xsens                        a sensor to try imunoise record with

imunoise COMMAND --help says more.)help";

}  // namespace

std::variant<Arguments, int> parse_arguments(int argc, const char* const* argv) {
  CLI::App program("imunoise: noise models of inertial sensors, from static recordings",
                   "imunoise");
  program.footer(kExamples);
  program.set_version_flag("--version", IMUNOISE_VERSION);
  program.require_subcommand(1);
  program.fallthrough();
  std::size_t threads = 0;
  program.add_option("--threads", threads, "Threads to use (results do not depend on it)")
      ->check(CLI::Range(1, 1024));
  std::vector<ParsedCommand> commands;
  for (const auto& group :
       {analysis_commands, array_commands, diagnosis_commands, recording_commands, device_commands,
        emulation_commands, replay_commands, catalogue_commands, batch_commands, daemon_commands}) {
    for (ParsedCommand& command : group(program)) commands.push_back(std::move(command));
  }
  try {
    program.parse(argc, argv);
    Arguments out;
    if (threads > 0) out.threads = threads;
    for (const ParsedCommand& command : commands) {
      if (command.app->parsed()) out.command = command.arguments();
    }
    return out;
  } catch (const CLI::ParseError& error) {
    const int status = program.exit(error);
    return status == 0 ? 0 : 2;
  }
}

}  // namespace imunoise::cli
