#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <thread>

#include "cli/commands/commands.h"
#include "cli/interrupt.h"
#include "cli/output.h"
#include "cli/study_input.h"
#include "daemon/process/spawning.h"
#include "daemon/service/page/page.h"
#include "daemon/service/service.h"
#include "study/analysis/preflights.h"
#include "study/ladder/study.h"

namespace imunoise::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{200};
constexpr std::chrono::seconds kReload{5};  // a page that is loaded again comes back sooner

// Files are shown; nothing is recorded.
class NothingRecorded : public service::CampaignControl {
 public:
  std::vector<service::CampaignSnapshot> campaigns() const override { return {}; }
  std::vector<v1::RejectedFile> rejected() const override { return {}; }
  std::string trouble() const override { return ""; }
  std::vector<v1::LiveReplicate> live() const override { return {}; }
  Result<v1::SampleRanges> samples(const v1::GetLiveSamplesRequest& request) const override {
    return tl::unexpected(unknown(request.campaign()).error());
  }
  Result<void> start(const std::string& campaign, bool) override { return unknown(campaign); }
  Result<void> stop(const std::string& campaign, const std::string&) override {
    return unknown(campaign);
  }
  void watch(Watcher) override {}

 private:
  static Result<void> unknown(const std::string& campaign) {
    return fail(fmt::format("there is no campaign '{}'; imunoised records", campaign));
  }
};

Result<v1::Study> compute(const v1::JobOrder& order, const Progress& progress) {
  const bool opens = order.request().has_open();
  const auto& named = opens ? order.request().open().witnesses() : order.study().witnesses();
  const std::vector<std::string> witnesses(named.begin(), named.end());
  const auto read = [&](const v1::StudyInput& input, const std::string& channel) {
    return read_study_input(input, channel, witnesses);
  };
  return study::apply(order.study(), order.request(), read, progress,
                      study::CachePlace{study::user_cache_folder()});
}

// The files with the names of their channels, which the first file tells. Error: as reading it, or
// it lacks a wanted channel.
Result<v1::NamedInput> named_input(const v1::StudyInput& input,
                                   const std::vector<std::string>& wanted) {
  v1::NamedInput out;
  const std::filesystem::path first = input.files(0);
  out.set_name((first.has_filename() ? first : first.parent_path()).filename().string());
  *out.mutable_input() = input;
  v1::StudyInput look = input;
  look.clear_files();
  look.add_files(input.files(0));
  // A channel that is not there is told with those that are.
  for (const std::string& one : wanted.empty() ? std::vector<std::string>{""} : wanted) {
    const auto there = read_study_input(look, one, {});
    if (!there) return tl::unexpected(there.error());
    *out.mutable_preflight() = study::preflights(*there);
    if (!wanted.empty()) {
      out.add_channels(one);
      continue;
    }
    for (const recording::Channel& channel : there->front().channels)
      out.add_channels(channel.name);
  }
  return out;
}

void open_browser(const std::string& url) {
  process::Spawning spawning;
  if (!spawning.start({"xdg-open", url})) tell("no browser was found: open the address yourself\n");
}

// Until it is interrupted, or nobody has looked for a while.
void wait_for_end(const service::Service& service, const std::stop_token& stop) {
  std::optional<Clock::time_point> looked;
  while (!stop.stop_requested()) {
    std::this_thread::sleep_for(kLook);
    if (service.listeners() > 0) looked = Clock::now();
    if (looked && Clock::now() - *looked > kReload) return;
  }
}

}  // namespace

int run(const OpenArguments& arguments) {
  const Interrupt interrupt;
  service::ServiceOptions options;
  options.listen.address = fmt::format("127.0.0.1:{}", arguments.port);
  options.by_invitation = true;
  options.bench = false;
  options.version = IMUNOISE_VERSION;
  options.studies = arguments.studies.empty() ? data_folder() / "studies" : arguments.studies;
  options.compute = compute;
  if (arguments.input.files_size() > 0) {
    auto input = named_input(arguments.input, arguments.channels);
    if (!input) return print_error(input.error());
    options.inputs.push_back(std::move(*input));
  }
  NothingRecorded control;
  const drivers::Drivers drivers;
  recording::DiskCalls calls;
  auto service = service::Service::start(options, {control, drivers, calls});
  if (!service) return print_error(service.error());
  const std::string place = arguments.study.empty() ? "/" : "/studies/" + arguments.study;
  const std::string url = fmt::format("http://127.0.0.1:{}/#{}?token={}", (*service)->port(), place,
                                      (*service)->invite());
  try_print(url + "\n");
  tell("Ctrl-C, or closing the last page, ends it.\n");
  const bool page = !service::page_assets().empty();
  if (!page)
    tell("This imunoise was built without the page: only programs find an answer there.\n");
  if (page && arguments.browser) open_browser(url);
  wait_for_end(**service, interrupt.token());
  return 0;
}

}  // namespace imunoise::cli
