#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>

#include "cli/commands/commands.h"
#include "cli/interrupt.h"
#include "cli/output.h"
#include "core/support/counted.h"
#include "daemon/app/status_text.h"
#include "imunoise/v1/service.pb.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::cli {
namespace {

constexpr std::chrono::seconds kTellEvery{10};  // of progress, elsewhere than on a terminal

// Prints an answer as it came, or what `text` makes of it.
template <class Answer, class Text>
int show_answer(const Result<std::string>& json, bool as_json, const Text& text) {
  if (!json) return print_error(json.error());
  Answer answer;
  if (auto read = read_answer(*json, answer); !read) return print_error(read.error());
  print(as_json ? *json : text(answer));
  return 0;
}

std::string device_text(const v1::DeviceList& list) {
  std::string out;
  for (const v1::BenchDevice& one : list.devices()) {
    std::string options;
    for (const v1::CampaignOption& option : one.device().options()) {
      options += fmt::format(" {}={}", option.name(), option.value());
    }
    out += report::clean_text(fmt::format("{} {}: {}{}{}", one.campaign(), one.device().name(),
                                          one.device().driver(), options,
                                          one.recorded_now() ? ", being recorded" : "")) +
           "\n";
  }
  return out.empty() ? "no devices\n" : out;
}

// "34 %, 2 h left"
std::string progress_text(const v1::CampaignState& state) {
  if (!state.has_left_s()) return "";
  return fmt::format("{:.0f} %, {} left", 100.0 * state.progress(),
                     report::duration(std::max(1.0, state.left_s())));
}

std::string state_text(const v1::CampaignState& state) {
  const std::string progress = progress_text(state);
  return report::clean_text(app::status_text(state.status()) +
                            (progress.empty() ? "" : " (" + progress + ")") +
                            (state.trouble().empty() ? "" : "; " + state.trouble())) +
         "\n";
}

std::string status_lines(const v1::CampaignList& list) {
  std::string out;
  for (const v1::CampaignState& one : list.campaigns()) out += state_text(one);
  for (const v1::RejectedFile& one : list.rejected()) {
    for (const std::string& problem : one.problems())
      out += report::clean_text("rejected: " + problem) + "\n";
  }
  return out.empty() ? "no campaigns\n" : out;
}

// What is known already of the replicates that are being recorded.
std::string live_lines(const v1::LiveList& list) {
  std::string out;
  for (const v1::LiveReplicate& replicate : list.replicates()) {
    for (const v1::LiveDevice& device : replicate.devices()) {
      const auto add = [&](const std::string& text) {
        out += report::clean_text(
                   fmt::format("  {} {}: {}", replicate.campaign(), device.device(), text)) +
               "\n";
      };
      if (!device.outlook().empty()) add(device.outlook());
      for (const v1::LiveWarning& warning : device.warnings()) add(warning.sentence());
    }
  }
  return out;
}

std::string campaign_lines(const v1::CampaignList& list) {
  std::string out;
  for (const v1::CampaignState& one : list.campaigns()) {
    const v1::Campaign& campaign = one.campaign();
    std::string devices;
    for (const v1::CampaignDevice& device : campaign.devices()) {
      devices += (devices.empty() ? "" : ", ") + device.name();
    }
    const auto& schedule = campaign.schedule();
    const std::string rhythm = schedule.has_every_s()
                                   ? "every " + report::duration(schedule.every_s())
                               : schedule.calendar().empty() ? "once"
                                                             : "by a timer, " + schedule.calendar();
    out += report::clean_text(fmt::format(
               "{}: {} of {}, {}; {}; into {}; {}", campaign.name(),
               counted(campaign.replicates(), "replicate"), report::duration(campaign.length_s()),
               rhythm, devices, campaign.folder(), one.running() ? "runs" : "does not run")) +
           "\n";
  }
  return out.empty() ? "no campaigns\n" : out;
}

// Tells every change on standard output, and progress on standard error: one line that is rewritten
// on a terminal.
class Follower {
 public:
  Follower() : terminal_(isatty(STDERR_FILENO) != 0) {}
  ~Follower() { clear(); }
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;

  // False once no campaign runs any more.
  bool take(const v1::CampaignState& state) {
    const std::string text = report::clean_text(app::status_text(state.status()));
    std::string& before = told_[state.status().campaign()];
    if (text != before) {
      clear();
      print(text + "\n");
      std::fflush(stdout);
      before = text;
    }
    running_[state.status().campaign()] = state.running();
    progress_[state.status().campaign()] = progress_text(state);
    show_progress();
    return std::any_of(running_.begin(), running_.end(),
                       [](const auto& one) { return one.second; });
  }

 private:
  void show_progress() {
    const auto now = std::chrono::steady_clock::now();
    if (!terminal_ && now - shown_ < kTellEvery) return;
    std::string all;
    for (const auto& [campaign, progress] : progress_) {
      if (!progress.empty())
        all += fmt::format("{}{}: {}", all.empty() ? "" : " | ", report::clean_text(campaign),
                           progress);
    }
    if (all.empty()) return;
    shown_ = now;
    fmt::print(stderr, "{}{}{}", terminal_ ? "\r\033[K" : "", all, terminal_ ? "" : "\n");
    std::fflush(stderr);
  }
  void clear() const {
    if (terminal_) fmt::print(stderr, "\r\033[K");
  }

  bool terminal_;
  std::chrono::steady_clock::time_point shown_;
  std::map<std::string, std::string> told_;
  std::map<std::string, std::string> progress_;
  std::map<std::string, bool> running_;
};

int follow(DaemonClient& client, bool as_json) {
  const Interrupt interrupt;
  Follower follower;
  std::size_t campaigns = 0;
  if (const auto json = client.get("/v1/campaigns"); json) {
    v1::CampaignList all;
    if (auto read = read_answer(*json, all); !read) return print_error(read.error());
    campaigns = static_cast<std::size_t>(all.campaigns_size());
  } else {
    return print_error(json.error());
  }
  std::size_t prepared = 0;  // events; the first of each campaign says what it does
  const auto done = client.follow(
      "/v1/events?topic=campaign",
      [&](std::string_view, const std::string& data) {
        v1::CampaignState state;
        if (!read_answer(data, state)) return true;
        if (as_json) print(data + "\n");
        const bool runs = as_json ? state.running() : follower.take(state);
        return ++prepared < campaigns || runs;
      },
      interrupt.token());
  return done ? 0 : print_error(done.error());
}

std::string target_of(const std::string& campaign, const char* what) {
  return fmt::format("/v1/campaigns/{}/{}", escaped(campaign), what);
}

}  // namespace

int run(const DevicesArguments& arguments) {
  auto client = DaemonClient::open(arguments.daemon);
  if (!client) return print_error(client.error());
  return show_answer<v1::DeviceList>(client->get("/v1/devices"), arguments.json, device_text);
}

int run(const CampaignsArguments& arguments) {
  auto client = DaemonClient::open(arguments.daemon);
  if (!client) return print_error(client.error());
  return show_answer<v1::CampaignList>(client->get("/v1/campaigns"), arguments.json,
                                       campaign_lines);
}

int run(const StatusArguments& arguments) {
  auto client = DaemonClient::open(arguments.daemon);
  if (!client) return print_error(client.error());
  if (arguments.follow) return follow(*client, arguments.json);
  const int status =
      show_answer<v1::CampaignList>(client->get("/v1/campaigns"), arguments.json, status_lines);
  if (status != 0 || arguments.json) return status;
  return show_answer<v1::LiveList>(client->get("/v1/live"), false, live_lines);
}

int run(const StartArguments& arguments) {
  auto client = DaemonClient::open(arguments.daemon);
  if (!client) return print_error(client.error());
  v1::StartCampaignRequest request;
  request.set_once(arguments.once);
  return show_answer<v1::CampaignState>(
      client->post(target_of(arguments.campaign, "start"), request), arguments.json, state_text);
}

int run(const StopArguments& arguments) {
  auto client = DaemonClient::open(arguments.daemon);
  if (!client) return print_error(client.error());
  v1::StopCampaignRequest request;
  request.set_recording(arguments.recording);
  return show_answer<v1::CampaignState>(
      client->post(target_of(arguments.campaign, "stop"), request), arguments.json,
      [&](const v1::CampaignState&) { return arguments.campaign + ": is being stopped\n"; });
}

}  // namespace imunoise::cli
