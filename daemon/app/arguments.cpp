#include "daemon/app/arguments.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>

#include "cli/manual/manual.h"
#include "daemon/app/manual.h"

namespace imunoise::app {
namespace {

constexpr const char* kExamples = R"help(
Examples:
  imunoised --check-config /etc/imunoise       check campaign files
  imunoised config/array.toml                  record on schedule until stopped
  imunoised --once config/array.toml           make one recording now
  imunoised --socket api.sock config           record, and serve imunoise status --socket api.sock

A campaign is a TOML file: imunoise-campaign(5). A folder means all *.toml files in it. imunoised skips files
with errors and logs them. The log goes to standard error.

Signals:
  SIGTERM, SIGINT   close recordings within seconds and exit; the next start continues them
  SIGHUP            read the campaign files again

Exit status:
  0   stopped, or nothing left to do and no file rejected
  1   all campaign files have errors, or nothing left to do and a file rejected
  2   wrong usage
  3   a disk that does not respond kept imunoised from closing its recordings)help";

// Options of the API as typed.
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
                  "Unix socket to serve the API on, for its owner and group")
      ->type_name("PATH")
      ->default_str("under systemd $RUNTIME_DIRECTORY/api.sock, else none");
  auto* const listen =
      program
          .add_option("--listen", raw.listen,
                      "Loopback address to serve the API on, too, such as 127.0.0.1:8080")
          ->type_name("ADDRESS");
  auto* const tokens =
      program
          .add_option(
              "--tokens", raw.tokens,
              "File of tokens for --listen, with lines \"viewer TOKEN\" or \"operator TOKEN\"")
          ->type_name("FILE")
          ->check(CLI::ExistingFile);
  listen->needs(tokens);
  tokens->needs(listen);
  program
      .add_option("--host", raw.hosts,
                  "Host name that clients may use for this machine, besides localhost")
      ->type_name("NAME")
      ->allow_extra_args(false);
  program.add_option("--studies", raw.studies, "Folder of the studies that clients make")
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
  CLI::App program("record campaigns of inertial sensors, unattended", "imunoised");
  manual::add_manual(program, 8, IMUNOISE_VERSION, described_files);
  program.footer(kExamples);
  Arguments out;
  std::vector<std::string> campaigns;
  std::vector<std::string> folders;
  program.add_option("CONFIG", campaigns, "Campaign files, or folders of them")->required();
  program.add_flag("--check-config", out.check_config,
                   "Check campaign files and exit; record nothing");
  program.add_flag("--print-timer", out.print_timer,
                   "Print the systemd timer drop-in of a campaign with a calendar and exit");
  program.add_flag(
      "--once", out.once,
      "Make one recording of each campaign and exit; an open recording is finished first");
  program.add_option("--driver-path", folders, "Folder to search for drivers first")
      ->type_name("FOLDER")
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
