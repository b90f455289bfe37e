#include "daemon/app/arguments.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>

namespace imunoise::app {
namespace {

constexpr const char* kExamples = R"help(
Examples:
  imunoised --check-config /etc/imunoise       what is wrong with these campaigns, and where
  imunoised config/array.toml                  record as their schedules say, until it is stopped
  imunoised --once config/array.toml           one recording, whatever the schedule says
  imunoised --socket api.sock config           and answer imunoise status --socket api.sock

A campaign is a TOML file; a folder stands for every *.toml in it. What happens is told on standard error.
SIGTERM and Ctrl-C end recordings in good order within seconds; started again, it goes on where it was. SIGHUP
reads the campaigns again. A file with an error is skipped, and the log says why.)help";

// What the options of the API come to once they are parsed.
struct RawApi {
  std::string socket;
  std::string listen;
  std::string tokens;
  std::vector<std::string> hosts;
  std::string studies = "studies";
};

// The folder that systemd made for the running service; empty elsewhere.
std::string socket_of_the_service() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing of ours changes the environment.
  const char* const folder = std::getenv("RUNTIME_DIRECTORY");
  return folder == nullptr ? "" : std::string(folder) + "/api.sock";
}

void add_api(CLI::App& program, RawApi& raw) {
  raw.socket = socket_of_the_service();
  program
      .add_option("--socket", raw.socket,
                  "Answer on a Unix socket, for its owner and group (default under systemd: "
                  "$RUNTIME_DIRECTORY/api.sock)")
      ->type_name("PATH");
  auto* const listen =
      program.add_option("--listen", raw.listen, "Answer on loopback TCP, too: 127.0.0.1:8080")
          ->type_name("ADDRESS");
  auto* const tokens =
      program
          .add_option("--tokens", raw.tokens,
                      "Who may come by TCP: a file with lines \"viewer TOKEN\", \"operator TOKEN\"")
          ->check(CLI::ExistingFile);
  listen->needs(tokens);
  tokens->needs(listen);
  program
      .add_option("--host", raw.hosts,
                  "A name by which clients may call this machine beside localhost; repeatable")
      ->allow_extra_args(false);
  program.add_option("--studies", raw.studies, "Where clients' studies are kept")
      ->type_name("FOLDER")
      ->capture_default_str();
}

void take_api(const RawApi& raw, Arguments& to) {
  if (!raw.socket.empty()) to.socket = raw.socket;
  if (!raw.listen.empty()) to.listen = raw.listen;
  if (!raw.tokens.empty()) to.tokens = raw.tokens;
  to.hosts = raw.hosts;
  to.studies = raw.studies;
}

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
  RawApi api;
  add_api(program, api);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int status = program.exit(error);
    return status == 0 ? 0 : 2;
  }
  out.campaigns.assign(campaigns.begin(), campaigns.end());
  out.driver_folders.assign(folders.begin(), folders.end());
  take_api(api, out);
  return out;
}

}  // namespace imunoise::app
