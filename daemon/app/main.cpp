// imunoised: composes configuration, drivers and campaigns; no logic of its own.

#include <fmt/format.h>
#include <malloc.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "core/support/counted.h"
#include "daemon/app/arguments.h"
#include "daemon/app/campaign_files.h"
#include "daemon/app/campaign_reload.h"
#include "daemon/app/last_resort.h"
#include "daemon/app/log.h"
#include "daemon/app/service_manager.h"
#include "daemon/app/study_process.h"
#include "daemon/app/supervisor.h"
#include "daemon/process/ignored_signals.h"
#include "daemon/service/service.h"
#include "drivers/host/load.h"

namespace imunoise::app {
namespace {

// SIGINT, SIGTERM and SIGHUP wait to be fetched. To be made before any thread, which inherits that.
sigset_t block_signals() {
  sigset_t out{};
  sigemptyset(&out);
  sigaddset(&out, SIGINT);
  sigaddset(&out, SIGTERM);
  sigaddset(&out, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &out, nullptr);
  return out;
}

int check_config(const CampaignFiles& files, const drivers::Drivers& drivers) {
  for (const CampaignFile& one : files.found) {
    fmt::print("{}: no errors: {}\n", one.file.string(), summary(one.campaign, drivers));
  }
  for (const std::string& problem : problems(files)) fmt::print("{}\n", problem);
  return files.rejected.empty() ? 0 : 1;
}

// What makes imunoise-campaign@NAME.timer follow the calendars of these campaigns.
int print_timer(const CampaignFiles& files) {
  for (const std::string& problem : problems(files)) fmt::print(stderr, "{}\n", problem);
  bool good = files.rejected.empty();
  for (const CampaignFile& one : files.found) {
    const std::string& calendar = one.campaign.schedule().calendar();
    if (calendar.empty()) {
      fmt::print(stderr, "{}: has no calendar; give it [schedule] calendar = \"...\"\n",
                 one.file.string());
      good = false;
      continue;
    }
    fmt::print("[Timer]\nOnCalendar=\nOnCalendar={}\n", calendar);
  }
  return good ? 0 : 1;
}

// Clients are answered where that was asked for. What keeps the daemon from it is told; recording
// goes on.
std::unique_ptr<service::Service> serve(const Arguments& arguments,
                                        const service::ServiceSubjects& subjects, Log& log) {
  if (!arguments.socket && !arguments.listen) return nullptr;
  service::ServiceOptions options;
  options.listen = {arguments.socket, arguments.listen};
  options.tokens = arguments.tokens;
  options.hosts = arguments.hosts;
  options.studies = arguments.studies;
  options.compute = compute_in_child(subjects.calls);
  options.version = IMUNOISE_VERSION;
  auto out = service::Service::start(options, subjects);
  if (!out) {
    log.error(fmt::format("API disabled: {}; recording continues", out.error().message));
    return nullptr;
  }
  if (arguments.socket) log.fact("answers on " + arguments.socket->string());
  if (arguments.listen)
    log.fact(fmt::format("answers on {}, port {}", *arguments.listen, (*out)->port()));
  return std::move(*out);
}

// Threads come and go with every replicate, and what they free malloc would keep in pieces, more of
// them every hour. Few arenas; what is large (a chunk being sealed) lies outside them, for which
// malloc would else stop after the first; what is free goes back every ten seconds.
class Memory {
 public:
  Memory() {
    constexpr int kLarge = 128 * 1024;
    mallopt(M_ARENA_MAX, 2);
    mallopt(M_MMAP_THRESHOLD, kLarge);
  }
  /// To be called five times a second.
  void keep_flat() {
    constexpr int kTenSeconds = 50;
    if (++calls_ % kTenSeconds == 0) malloc_trim(0);
  }

 private:
  int calls_ = 0;
};

// What was read again, once it was.
void apply(std::optional<CampaignFiles> files, Supervisor& supervisor, Log& log) {
  if (!files) return;
  for (const std::string& problem : problems(*files)) log.error(problem);
  log.fact(fmt::format("SIGHUP: {} in force, {} rejected", counted(files->found.size(), "campaign"),
                       counted(files->rejected.size(), "file")));
  supervisor.reload(std::move(*files));
}

int record(const Arguments& arguments, CampaignFiles files, const drivers::Drivers& drivers,
           const sigset_t& signals) {
  Log log;
  for (const std::string& problem : problems(files)) log.error(problem);
  if (files.found.empty()) return 1;
  Memory memory;
  ServiceManager manager;
  recording::DiskCalls calls;
  Supervisor supervisor(std::move(files), drivers,
                        arguments.once ? acquire::RunMode::kOnce : acquire::RunMode::kScheduled,
                        calls, log);
  LastResort last_resort(supervisor, log);
  const auto service = serve(arguments, {supervisor, drivers, calls}, log);
  CampaignReload reload(arguments.campaigns, drivers, calls);
  manager.ready();
  bool stays = service != nullptr && !arguments.once;  // clients may start campaigns again
  bool stopping = false;
  std::string told;
  constexpr timespec kPatience{0, 200'000'000};
  while (stays || !supervisor.ended()) {
    const int signal = sigtimedwait(&signals, nullptr, &kPatience);
    if (signal == SIGHUP) {
      if (arguments.once) {
        log.fact("SIGHUP ignored: --once reads campaigns only at the start");
      } else {
        reload.request();
      }
    } else if (signal > 0) {
      log.fact(fmt::format("{}: closing recordings", signal == SIGTERM ? "SIGTERM" : "SIGINT"));
      manager.stopping();
      supervisor.stop();
      stays = false;
      stopping = true;
      last_resort.begin();
    }
    if (!stopping) apply(reload.poll([&] { return supervisor.in_force(); }), supervisor, log);
    if (supervisor.hanging().empty()) manager.alive();  // else systemd may start us again
    supervisor.settle();
    supervisor.tell_warnings();
    memory.keep_flat();
    if (const std::string status = supervisor.status(); status != told) {
      manager.status(status);
      told = status;
    }
  }
  last_resort.begin();
  return stopping || supervisor.rejected().empty() ? 0 : 1;
}

int run(int argc, const char* const* argv) {
  if (argc == 2 && argv[1] == std::string_view(kComputeWord))
    return compute_for_parent(std::cin, std::cout);
  const auto parsed = parse_arguments(argc, argv);
  if (const int* const status = std::get_if<int>(&parsed)) return *status;
  const auto& arguments = std::get<Arguments>(parsed);
  const sigset_t signals = block_signals();
  const process::IgnoredSignals ignored;
  const drivers::Drivers drivers =
      drivers::load_drivers(drivers::driver_folders(arguments.driver_folders));
  CampaignFiles files = read_campaigns(arguments.campaigns, drivers);
  if (arguments.check_config) return check_config(files, drivers);
  if (arguments.print_timer) return print_timer(files);
  return record(arguments, std::move(files), drivers, signals);
}

}  // namespace
}  // namespace imunoise::app

int main(int argc, char** argv) {
  try {
    return imunoise::app::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "imunoised: {}\n", error.what());
    return 1;
  }
}
