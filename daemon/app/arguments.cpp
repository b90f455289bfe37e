#include "daemon/app/arguments.h"

#include <CLI/CLI.hpp>
#include <string>

namespace imunoise::app {
namespace {

constexpr const char* kExamples = R"help(
Examples:
  imunoised --check-config /etc/imunoise       what is wrong with these campaigns, and where
  imunoised config/array.toml                  record as their schedules say, until it is stopped
  imunoised --once config/array.toml           one recording, whatever the schedule says

A campaign is a TOML file; a folder stands for every *.toml in it. What happens is told on standard error.
SIGTERM and Ctrl-C end recordings in good order within seconds; started again, it goes on where it was.)help";

}  // namespace

std::variant<Arguments, int> parse_arguments(int argc, const char* const* argv) {
  CLI::App program("imunoised: records campaigns of inertial sensors, unattended", "imunoised");
  program.footer(kExamples);
  program.set_version_flag("--version", IMUNOISE_VERSION);
  Arguments out;
  std::vector<std::string> campaigns;
  std::vector<std::string> folders;
  program.add_option("CONFIG", campaigns, "Campaigns: TOML files, or folders of them")->required();
  program.add_flag("--check-config", out.check_config,
                   "Say what is wrong with the campaigns, and where; record nothing");
  program.add_flag("--print-timer", out.print_timer,
                   "Print the timer's drop-in for a campaign with a calendar; record nothing");
  program.add_flag("--once", out.once,
                   "Make one recording of each campaign: the unfinished one, or else a new one");
  program
      .add_option("--driver-path", folders,
                  "A folder to search for drivers before the others; repeatable")
      ->check(CLI::ExistingDirectory)
      ->allow_extra_args(false);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int status = program.exit(error);
    return status == 0 ? 0 : 2;
  }
  out.campaigns.assign(campaigns.begin(), campaigns.end());
  out.driver_folders.assign(folders.begin(), folders.end());
  return out;
}

}  // namespace imunoise::app
