#include "cli/parse/daemon_options.h"

namespace imunoise::cli {
namespace {

constexpr const char* kDevicesExamples = R"help(
Examples:
  imunoise devices
  imunoise devices --json)help";

constexpr const char* kCampaignsExamples = R"help(
Examples:
  imunoise campaigns
  imunoise campaigns --url http://127.0.0.1:8080 --token-file ~/.config/imunoise.token)help";

constexpr const char* kStatusExamples = R"help(
Examples:
  imunoise status                              current campaigns and time remaining
  imunoise status --follow                     print every change until no campaign runs
  imunoise status --url http://127.0.0.1:8080 --token-file ~/.config/imunoise.token)help";

constexpr const char* kLiveExamples = R"help(
Examples:
  imunoise live                                what the recorded samples show so far
  imunoise live --json > live.json

A deviation with ± needs more samples until its 95 % interval is within a factor of two.)help";

constexpr const char* kStopExamples = R"help(
Examples:
  imunoise stop array                                    refused while a replicate is recorded
  imunoise stop array --recording 2026-03-01T060000Z     interrupts this recording)help";

constexpr const char* kStartExamples = R"help(
Examples:
  imunoise start array                         follow its schedule
  imunoise start array --once                  one recording: finish the open one, or start a new one)help";

// A command with the options of all of them. `more` adds its own.
template <class Arguments, class More>
ParsedCommand daemon_command(CLI::App& program, const char* name, const char* about,
                             const More& more) {
  CLI::App* const command = program.add_subcommand(name, about);
  const auto typed = std::make_shared<Arguments>();
  const auto daemon = std::make_shared<RawDaemon>();
  add_daemon(*command, *daemon);
  command->add_flag("--json", typed->json, "Print the result as JSON");
  more(*command, *typed);
  return {command, [typed, daemon] {
            typed->daemon = daemon_from(*daemon);
            return *typed;
          }};
}

}  // namespace

void add_daemon(CLI::App& command, RawDaemon& raw) {
  const auto& known = DaemonArguments().socket;
  command.add_option("--socket", raw.socket, "Unix socket of imunoised")
      ->type_name("PATH")
      ->default_str(known.string());
  auto* const url = command
                        .add_option("--url", raw.url,
                                    "Address of imunoised over TCP, such as http://127.0.0.1:8080")
                        ->type_name("URL");
  command.add_option("--token-file", raw.token_file, "File with the token for --url")
      ->type_name("FILE")
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
  return {
      daemon_command<DevicesArguments>(
          program, "devices", "List the devices of imunoised",
          [](CLI::App& command, DevicesArguments&) { command.footer(kDevicesExamples); }),
      daemon_command<CampaignsArguments>(
          program, "campaigns", "List the campaigns of imunoised",
          [](CLI::App& command, CampaignsArguments&) { command.footer(kCampaignsExamples); }),
      daemon_command<StatusArguments>(
          program, "status", "Show current campaigns and time remaining",
          [](CLI::App& command, StatusArguments& to) {
            command.footer(kStatusExamples);
            command.add_flag("--follow", to.follow, "Print every change until no campaign runs");
          }),
      daemon_command<LiveArguments>(
          program, "live", "Show the wavelet deviations and warnings of current replicates",
          [](CLI::App& command, LiveArguments&) { command.footer(kLiveExamples); }),
      daemon_command<StartArguments>(
          program, "start", "Start a campaign that is stopped or finished",
          [](CLI::App& command, StartArguments& to) {
            command.footer(kStartExamples);
            command.add_option("CAMPAIGN", to.campaign, "Name of the campaign")->required();
            command.add_flag("--once", to.once, "Make one recording now, whatever the schedule");
          }),
      daemon_command<StopArguments>(
          program, "stop", "Stop a campaign", [](CLI::App& command, StopArguments& to) {
            command.footer(kStopExamples);
            command.add_option("CAMPAIGN", to.campaign, "Name of the campaign")->required();
            command.add_option("--recording", to.recording, "Name of the recording to interrupt")
                ->type_name("NAME")
                ->default_str("none");
          })};
}

}  // namespace imunoise::cli
