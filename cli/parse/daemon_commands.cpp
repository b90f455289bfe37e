#include "cli/parse/daemon_options.h"

namespace imunoise::cli {
namespace {

constexpr const char* kStatusExamples = R"help(
Examples:
  imunoise status                              what each campaign does now
  imunoise status --follow                     every change, and how long it takes still
  imunoise status --url http://127.0.0.1:8080 --token-file ~/.config/imunoise.token)help";

constexpr const char* kStopExamples = R"help(
Examples:
  imunoise stop array                                    unless it records a replicate
  imunoise stop array --recording 2026-03-01T060000Z     interrupts this recording, too)help";

constexpr const char* kStartExamples = R"help(
Examples:
  imunoise start array                         as its schedule says
  imunoise start array --once                  one recording: the unfinished one, or else a new one)help";

// A command with the options of all of them. `more` adds its own.
template <class Arguments, class More>
ParsedCommand daemon_command(CLI::App& program, const char* name, const char* about,
                             const More& more) {
  CLI::App* const command = program.add_subcommand(name, about);
  const auto typed = std::make_shared<Arguments>();
  const auto daemon = std::make_shared<RawDaemon>();
  add_daemon(*command, *daemon);
  command->add_flag("--json", typed->json, "Print JSON");
  more(*command, *typed);
  return {command, [typed, daemon] {
            typed->daemon = daemon_from(*daemon);
            return *typed;
          }};
}

}  // namespace

void add_daemon(CLI::App& command, RawDaemon& raw) {
  const auto& known = DaemonArguments().socket;
  command
      .add_option("--socket", raw.socket,
                  "Where imunoised answers (default: " + known.string() + ")")
      ->type_name("PATH");
  auto* const url = command.add_option("--url", raw.url, "The same by TCP: http://127.0.0.1:8080")
                        ->type_name("URL");
  command.add_option("--token-file", raw.token_file, "A file with the token for it")
      ->check(CLI::ExistingFile)
      ->needs(url);
}

DaemonArguments daemon_from(const RawDaemon& raw) {
  DaemonArguments out;
  if (!raw.socket.empty()) out.socket = raw.socket;
  out.url = raw.url;
  if (!raw.token_file.empty()) out.token_file = raw.token_file;
  return out;
}

std::vector<ParsedCommand> daemon_commands(CLI::App& program) {
  const auto nothing = [](CLI::App&, auto&) {};
  return {
      daemon_command<DevicesArguments>(program, "devices", "The devices of the daemon's campaigns",
                                       nothing),
      daemon_command<CampaignsArguments>(program, "campaigns", "The daemon's campaigns", nothing),
      daemon_command<StatusArguments>(
          program, "status", "What the daemon's campaigns do",
          [](CLI::App& command, StatusArguments& to) {
            command.footer(kStatusExamples);
            command.add_flag("--follow", to.follow, "Tell every change, until no campaign runs");
          }),
      daemon_command<StartArguments>(
          program, "start", "Start a campaign that was stopped or is finished",
          [](CLI::App& command, StartArguments& to) {
            command.footer(kStartExamples);
            command.add_option("CAMPAIGN", to.campaign)->required();
            command.add_flag("--once", to.once, "One recording, whatever the schedule says");
          }),
      daemon_command<StopArguments>(
          program, "stop", "Stop a campaign", [](CLI::App& command, StopArguments& to) {
            command.footer(kStopExamples);
            command.add_option("CAMPAIGN", to.campaign)->required();
            command.add_option("--recording", to.recording,
                               "The recording that is to be interrupted; without it none is");
          })};
}

}  // namespace imunoise::cli
