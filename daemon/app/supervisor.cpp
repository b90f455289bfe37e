#include "daemon/app/supervisor.h"

#include <fmt/format.h>

#include <utility>

#include "daemon/app/status_text.h"

namespace imunoise::app {
namespace {

// A program that was installed, or built, with this one.
std::filesystem::path beside_us(const char* program) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / program;
}

}  // namespace

Supervisor::Supervisor(const std::vector<CampaignFile>& campaigns, const drivers::Drivers& drivers,
                       acquire::RunMode mode, Log& log)
    : mode_(mode),
      log_(log),
      recorder_(
          recording::posix_file_system(), drivers,
          [this](const std::string& device, std::string_view text) {
            log_.chatter(device, std::string(text));
          },
          [this](const std::string& campaign) { return &live_.of(campaign); }),
      aftercare_(recording::posix_file_system(), beside_us("imunoise")) {
  const std::lock_guard lock(mutex_);
  for (const CampaignFile& one : campaigns)
    runs_[one.campaign.name()].state.campaign = one.campaign;
  for (auto& [name, run] : runs_) {
    if (!left_to_timer(run.state.campaign)) {
      begin(run, mode_);
      continue;
    }
    log_.fact(fmt::format("{}: is left to its timer ({}), which starts imunoised --once", name,
                          run.state.campaign.schedule().calendar()));
  }
}

Supervisor::~Supervisor() { stop(); }

bool Supervisor::left_to_timer(const v1::Campaign& campaign) const {
  return mode_ == acquire::RunMode::kScheduled && !campaign.schedule().calendar().empty();
}

void Supervisor::stop() {
  const std::lock_guard lock(mutex_);
  ending_ = true;
  for (auto& [name, run] : runs_) run.stop.request_stop();
}

void Supervisor::begin(Run& run, acquire::RunMode mode) {
  run.state.running = true;
  run.state.status.Clear();
  run.state.status.set_campaign(run.state.campaign.name());
  run.stop = std::stop_source();
  ++running_;
  run.thread = std::jthread([this, &campaign = run.state.campaign, mode,
                             stop = run.stop.get_token()] { this->run(campaign, mode, stop); });
}

void Supervisor::run(const v1::Campaign& campaign, acquire::RunMode mode,
                     const std::stop_token& stop) {
  acquire::CampaignSurroundings with{clock_, recording::posix_file_system(), recorder_};
  if (campaign.calibration().enabled()) {
    with.calibrate = [this](const auto& of, const auto& recording, const Progress& progress) {
      return aftercare_.calibrate(of, recording, progress);
    };
  }
  with.publish = [this](const auto& of, const auto& recording, const Progress& progress) {
    return aftercare_.publish(of, recording, progress);
  };
  with.tell = [this](const v1::CampaignStatus& status) { take(status); };
  acquire::run_campaign(campaign, mode, with, stop);
  log_.fact(fmt::format("{}: ended", campaign.name()));
  end(campaign.name());
}

void Supervisor::take(const v1::CampaignStatus& status) {
  if (status.phase() == v1::held_up) {
    log_.warning(status_text(status));
  } else {
    log_.fact(status_text(status));
  }
  {
    const std::lock_guard lock(mutex_);
    runs_.at(status.campaign()).state.status = status;
  }
  tell(status.campaign());
}

void Supervisor::end(const std::string& campaign) {
  {
    const std::lock_guard lock(mutex_);
    service::BenchCampaign& state = runs_.at(campaign).state;
    state.running = false;
    if (state.status.phase() != v1::finished) {
      state.status.set_phase(v1::finished);
      state.status.clear_until_ns();
      state.status.set_reason("it was stopped");
    }
  }
  tell(campaign);
  --running_;
}

void Supervisor::tell(const std::string& campaign) {
  const std::lock_guard lock(watching_);
  if (watcher_) watcher_(campaign);
}

void Supervisor::watch(Watcher changed) {
  const std::lock_guard lock(watching_);
  watcher_ = std::move(changed);
}

void Supervisor::tell_warnings() {
  for (const std::string& one : live_.new_warnings()) log_.warning(one);
}

std::string Supervisor::status() const {
  const std::lock_guard lock(mutex_);
  std::string out;
  for (const auto& [name, run] : runs_) {
    if (run.state.status.phase() == v1::campaign_phase_unspecified) continue;
    out += (out.empty() ? "" : " | ") + status_text(run.state.status);
  }
  return out;
}

std::vector<service::BenchCampaign> Supervisor::campaigns() const {
  const std::lock_guard lock(mutex_);
  std::vector<service::BenchCampaign> out;
  for (const auto& [name, run] : runs_) out.push_back(run.state);
  return out;
}

Result<void> Supervisor::start(const std::string& campaign, bool once) {
  std::jthread before;  // joined without the mutex, which it may still want
  const std::lock_guard lock(mutex_);
  Run& run = runs_.at(campaign);
  if (ending_) return fail("the daemon is ending");
  if (run.state.running) return fail(campaign + ": runs already");
  if (left_to_timer(run.state.campaign)) {
    return fail(
        fmt::format("{0}: is started by its timer; systemctl start imunoise-campaign@{0} "
                    "records it now",
                    campaign));
  }
  before = std::move(run.thread);
  begin(run, once ? acquire::RunMode::kOnce : mode_);
  log_.fact(campaign + ": was started by a client");
  return {};
}

Result<void> Supervisor::stop(const std::string& campaign, const std::string& recording) {
  const std::lock_guard lock(mutex_);
  Run& run = runs_.at(campaign);
  if (!run.state.running) return fail(campaign + ": does not run");
  const std::string under_way = service::recording_under_way(run.state.status);
  if (!under_way.empty() && recording != under_way) {
    return fail(
        fmt::format("{}: replicate {} of {} of recording {} is being recorded and would be "
                    "interrupted; to stop it all the same, name it: recording = {}",
                    campaign, run.state.status.replicate(), run.state.status.replicates(),
                    under_way, under_way));
  }
  if (under_way.empty() && !recording.empty()) {
    return fail(
        fmt::format("{}: does not record {} at the moment; to stop what it does, name no "
                    "recording",
                    campaign, recording));
  }
  run.stop.request_stop();
  log_.warning(campaign + ": was stopped by a client");
  return {};
}

}  // namespace imunoise::app
