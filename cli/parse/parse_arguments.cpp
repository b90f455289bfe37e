#include <CLI/CLI.hpp>

#include "cli/arguments.h"
#include "cli/manual/manual.h"
#include "cli/parse/commands.h"
#include "cli/parse/unknown_word.h"

namespace imunoise::cli {
namespace {

constexpr const char* kExamples = R"help(
Examples:
  imunoise fit run?.h5 --channel gyro_x                  fit a noise model to all replicates
  imunoise fit run?.h5 --model "2*AR1 + WN + RW" --report gyro.html
  imunoise test run?.h5 --model "AR1 + WN + RW"          check the fit and compare replicates
  imunoise diagnose run?.h5 --model "WN + RW" --auto     add the physical effects that it lacks
  imunoise open run?.h5                                  see it in the browser
  imunoise record monday --device "xsens port=/dev/ttyUSB0" --duration 3600 --replicates 6
  imunoise calibrate monday                              fit all channels of a recording
  imunoise export imu.json --to kalibr                   write noise values for another program
  imunoise history recordings --device 0042              compare calibrations over months
  imunoise status --follow                               watch campaigns of imunoised

imunoise COMMAND --help lists the options of a command. A value in brackets is the default.

Exit status:
  0   there is a result, also if the model does not fit
  1   an error, a damaged recording, or a device that changed
  2   wrong usage
  3   the model does not fit, and --fail-if-misfit was given)help";

// Commands stand in --help, the manual and completion in this order.
struct Group {
  const char* title;
  std::vector<std::vector<ParsedCommand> (*)(CLI::App&)> members;
};

const std::vector<Group>& groups() {
  static const std::vector<Group> kGroups = {
      {"Analyse recordings",
       {analysis_commands, diagnosis_commands, open_commands, array_commands, export_commands,
        datasheet_commands}},
      {"Record, replay and simulate",
       {recording_commands, replay_commands, device_commands, emulation_commands}},
      {"Manage many recordings", {catalogue_commands, batch_commands}},
      {"Control imunoised", {daemon_commands}}};
  return kGroups;
}

std::vector<ParsedCommand> add_commands(CLI::App& program) {
  std::vector<ParsedCommand> out;
  for (const Group& group : groups()) {
    for (const auto member : group.members) {
      for (ParsedCommand& command : member(program)) out.push_back(std::move(command));
    }
    for (CLI::App* const command : program.get_subcommands({})) {
      if (command->get_group() == "Subcommands") command->group(group.title);
    }
  }
  return out;
}

}  // namespace

std::variant<Arguments, int> parse_arguments(int argc, const char* const* argv) {
  CLI::App program("noise models of inertial sensors from static recordings", "imunoise");
  manual::add_manual(program, 1, IMUNOISE_VERSION);
  program.footer(kExamples);
  program.require_subcommand(1);
  program.fallthrough();
  program.failure_message(usage_error);
  std::size_t threads = 0;
  program.add_option("--threads", threads, "Number of threads; results do not depend on it")
      ->type_name("COUNT")
      ->default_str("all processors")
      ->check(CLI::Range(1, 1024));
  const std::vector<ParsedCommand> commands = add_commands(program);
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
