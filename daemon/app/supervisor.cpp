#include "daemon/app/supervisor.h"

#include <fmt/format.h>
#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <utility>

#include "daemon/app/status_text.h"

namespace imunoise::app {
namespace {

// A program that was installed, or built, with this one.
std::filesystem::path beside_us(const char* program) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / program;
}

std::map<std::string, CampaignFile> by_name(std::vector<CampaignFile> files) {
  std::map<std::string, CampaignFile> out;
  for (CampaignFile& one : files) {
    std::string name = one.campaign.name();
    out.emplace(std::move(name), std::move(one));
  }
  return out;
}

bool same(const v1::Campaign& a, const v1::Campaign& b) {
  return google::protobuf::util::MessageDifferencer::Equals(a, b);
}

}  // namespace

Supervisor::Supervisor(CampaignFiles files, const drivers::Drivers& drivers, acquire::RunMode mode,
                       recording::DiskCalls& calls, Log& log)
    : mode_(mode),
      log_(log),
      calls_(calls),
      files_(recording::posix_file_system(), calls),
      recorder_(
          files_, drivers,
          [this](const std::string& device, std::string_view text) {
            log_.chatter(device, std::string(text));
          },
          [this](const std::string& campaign) { return &live_.of(campaign); }),
      aftercare_(files_, calls, beside_us("imunoise")) {
  rejected_ = std::move(files.rejected);
  wanted_ = by_name(std::move(files.found));
  settle();
}

Supervisor::~Supervisor() { stop(); }

void Supervisor::reload(CampaignFiles files) {
  {
    const std::lock_guard lock(mutex_);
    auto wanted = by_name(std::move(files.found));
    tell_changes(wanted);
    wanted_ = std::move(wanted);
    rejected_ = std::move(files.rejected);
  }
  settle();
}

void Supervisor::tell_changes(const std::map<std::string, CampaignFile>& wanted) const {
  const auto when = [this](const std::string& name) {
    const auto run = runs_.find(name);
    const bool records = run != runs_.end() && run->second.state.running &&
                         run->second.state.status.phase() == v1::recording;
    return records ? "after the current replicate" : "now";
  };
  for (const auto& [name, file] : wanted_) {
    const auto after = wanted.find(name);
    if (after == wanted.end()) {
      log_.fact(fmt::format("{}: campaign file deleted; the campaign ends {}", name, when(name)));
    } else if (!same(after->second.campaign, file.campaign)) {
      log_.fact(
          fmt::format("{}: campaign file changed; the change takes effect {}", name, when(name)));
    }
  }
  for (const auto& [name, file] : wanted) {
    if (!wanted_.contains(name))
      log_.fact(fmt::format("{}: is new, from {}", name, file.file.string()));
  }
}

std::vector<CampaignFile> Supervisor::in_force() const {
  const std::lock_guard lock(mutex_);
  std::vector<CampaignFile> out;
  for (const auto& [name, file] : wanted_) out.push_back(file);
  return out;
}

// A campaign that was asked to leave does so, also if its file is again as it was.
bool Supervisor::as_wanted(const Runs::value_type& run) const {
  const auto wanted = wanted_.find(run.first);
  return wanted != wanted_.end() && !run.second.leave.stop_requested() &&
         same(wanted->second.campaign, run.second.state.campaign);
}

bool Supervisor::folder_is_free(const std::filesystem::path& folder) const {
  return std::none_of(runs_.begin(), runs_.end(), [&](const Runs::value_type& one) {
    return one.second.state.running && one.second.folder == folder;
  });
}

void Supervisor::settle() {
  std::vector<std::jthread> over;  // joined without the mutex, which they may still want
  const std::lock_guard lock(mutex_);
  if (ending_) return;
  for (auto one = runs_.begin(); one != runs_.end();) {
    Run& run = one->second;
    const auto wanted = wanted_.find(one->first);
    if (as_wanted(*one)) {
      ++one;
    } else if (run.state.running) {
      run.leave.request_stop();
      ++one;
    } else if (wanted != wanted_.end() && run.by_client) {  // who stopped it starts it again
      run.state.campaign = wanted->second.campaign;
      run.folder = wanted->second.folder;
      run.leave = std::stop_source();
      ++one;
    } else {
      over.push_back(std::move(run.thread));
      one = runs_.erase(one);
    }
  }
  for (const auto& [name, file] : wanted_) {
    if (runs_.contains(name) || !folder_is_free(file.folder)) continue;
    Run& run = runs_[name];
    run.state.campaign = file.campaign;
    run.folder = file.folder;
    begin_unless_left(run);
  }
}

bool Supervisor::ended() const {
  const std::lock_guard lock(mutex_);
  const bool settled =
      runs_.size() == wanted_.size() &&
      std::all_of(runs_.begin(), runs_.end(), [this](const auto& one) { return as_wanted(one); });
  return running_ == 0 && (ending_ || settled);
}

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
  run.leave = std::stop_source();
  run.by_client = false;
  ++running_;
  run.thread =
      std::jthread([this, &campaign = run.state.campaign, mode, stop = run.stop.get_token(),
                    leave = run.leave.get_token()] { this->run(campaign, mode, stop, leave); });
}

void Supervisor::begin_unless_left(Run& run) {
  const v1::Campaign& campaign = run.state.campaign;
  if (!left_to_timer(campaign)) return begin(run, mode_);
  log_.fact(fmt::format("{}: is left to its timer ({}), which starts imunoised --once",
                        campaign.name(), campaign.schedule().calendar()));
}

void Supervisor::run(const v1::Campaign& campaign, acquire::RunMode mode,
                     const std::stop_token& stop, const std::stop_token& leave) {
  acquire::CampaignSurroundings with{clock_, files_, recorder_};
  if (campaign.calibration().enabled()) {
    with.calibrate = [this](const auto& of, const auto& recording, const Progress& progress) {
      return aftercare_.calibrate(of, recording, progress);
    };
  }
  with.publish = [this](const auto& of, const auto& recording, const Progress& progress) {
    return aftercare_.publish(of, recording, progress);
  };
  with.tell = [this](const v1::CampaignStatus& status) { take(status); };
  with.leave = leave;
  const std::string name = campaign.name();  // the campaign may go with its end
  acquire::run_campaign(campaign, mode, with, stop);
  log_.fact(fmt::format("{}: ended", name));
  end(name);
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
    service::CampaignSnapshot& state = runs_.at(campaign).state;
    state.running = false;
    if (state.status.phase() != v1::finished) {
      state.status.set_phase(v1::finished);
      state.status.clear_until_ns();
      state.status.set_reason("stopped");
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
  tell_troubles();
}

void Supervisor::tell_troubles() {
  Troubles now = troubles();
  std::vector<std::string> changed;
  for (const auto& [name, trouble] : now) {
    const auto before = told_.find(name);
    if (before != told_.end() && before->second.since == trouble.since) continue;
    const std::string text = name + ": " + live::sentence(trouble);
    trouble.hangs ? log_.error(text) : log_.warning(text);
    changed.push_back(name);
  }
  for (const auto& [name, trouble] : told_) {
    if (now.contains(name)) continue;
    log_.fact(fmt::format("{}: failed: {}", name, live::sentence(trouble)));
    changed.push_back(name);
  }
  told_ = std::move(now);
  for (const std::string& name : changed) tell(name);
}

Troubles Supervisor::troubles() const {
  std::vector<v1::Campaign> campaigns;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [name, run] : runs_) campaigns.push_back(run.state.campaign);
  }
  return find_troubles(campaigns, calls_.pending(), live_, live::Steady::now());
}

std::string Supervisor::hanging(std::chrono::seconds at_least) const {
  return hanging_since(troubles(), live::Steady::now() - at_least);
}

std::string Supervisor::trouble() const {
  const Troubles all = troubles();
  const auto found = all.find(kNoCampaign);
  return found == all.end() ? "" : live::sentence(found->second);
}

std::string Supervisor::status() const {
  const auto troubles = this->troubles();
  const std::lock_guard lock(mutex_);
  std::string out;
  for (const auto& [name, run] : runs_) {
    if (run.state.status.phase() == v1::campaign_phase_unspecified) continue;
    out += (out.empty() ? "" : " | ") + status_text(run.state.status);
    const auto trouble = troubles.find(name);
    if (trouble != troubles.end()) out += "; " + live::sentence(trouble->second);
  }
  if (const auto other = troubles.find(kNoCampaign); other != troubles.end())
    out += (out.empty() ? "" : " | ") + live::sentence(other->second);
  std::string files;
  for (const v1::RejectedFile& one : rejected_) files += (files.empty() ? "" : ", ") + one.file();
  if (!files.empty()) out += (out.empty() ? "" : " | ") + ("rejected campaign files: " + files);
  return out;
}

std::vector<v1::RejectedFile> Supervisor::rejected() const {
  const std::lock_guard lock(mutex_);
  return rejected_;
}

std::vector<service::CampaignSnapshot> Supervisor::campaigns() const {
  const auto troubles = this->troubles();
  const std::lock_guard lock(mutex_);
  std::vector<service::CampaignSnapshot> out;
  for (const auto& [name, run] : runs_) {
    out.push_back(run.state);
    const auto trouble = troubles.find(name);
    if (trouble != troubles.end()) out.back().trouble = live::sentence(trouble->second);
  }
  return out;
}

Result<void> Supervisor::start(const std::string& campaign, bool once) {
  std::jthread before;  // joined without the mutex, which it may still want
  const std::lock_guard lock(mutex_);
  const auto found = runs_.find(campaign);
  if (found == runs_.end()) return fail(campaign + ": its campaign file was deleted");
  Run& run = found->second;
  if (ending_) return fail("the daemon is ending");
  if (run.state.running) return fail(campaign + ": is already running");
  if (left_to_timer(run.state.campaign)) {
    return fail(
        fmt::format("{0}: is started by its timer; systemctl start imunoise-campaign@{0} "
                    "records it now",
                    campaign));
  }
  if (!folder_is_free(run.folder))
    return fail(campaign + ": another campaign still records into its folder; try again later");
  before = std::move(run.thread);
  begin(run, once ? acquire::RunMode::kOnce : mode_);
  log_.fact(campaign + ": was started by a client");
  return {};
}

Result<void> Supervisor::stop(const std::string& campaign, const std::string& recording) {
  const std::lock_guard lock(mutex_);
  const auto found = runs_.find(campaign);
  if (found == runs_.end()) return fail(campaign + ": its campaign file was deleted");
  Run& run = found->second;
  if (!run.state.running) return fail(campaign + ": is not running");
  const std::string under_way = service::recording_under_way(run.state.status);
  if (!under_way.empty() && recording != under_way) {
    return fail(
        fmt::format("{}: replicate {} of {} of recording {} is being recorded and would be "
                    "interrupted; to stop it anyway, name it: --recording {}",
                    campaign, run.state.status.replicate(), run.state.status.replicates(),
                    under_way, under_way));
  }
  if (under_way.empty() && !recording.empty()) {
    return fail(
        fmt::format("{}: is not recording {}; to stop the campaign, name no "
                    "recording",
                    campaign, recording));
  }
  run.by_client = true;
  run.stop.request_stop();
  log_.warning(campaign + ": was stopped by a client");
  return {};
}

}  // namespace imunoise::app
