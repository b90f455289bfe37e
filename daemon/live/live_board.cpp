#include "daemon/live/live_board.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace imunoise::live {

void LiveReplicate::begin(const acquire::ReplicatePlan& plan,
                          const std::vector<v1::RecordedDevice>& devices) {
  const std::lock_guard lock(mutex_);
  about_.set_campaign(campaign_);
  about_.set_recording(plan.folder.string());
  about_.set_replicate(plan.replicate);
  about_.set_length_s(plan.duration ? plan.duration->count() : 0.0);
  devices_.clear();
  told_.clear();
  beat_ = Steady::now();
  for (const v1::RecordedDevice& one : devices) devices_.push_back(std::make_shared<Watched>(one));
}

void LiveReplicate::watch(std::function<recording::RecorderState()> recorder) {
  const std::lock_guard lock(asking_);
  recorder_ = std::move(recorder);
}

recording::RecorderState LiveReplicate::recorder_state() const {
  const std::lock_guard lock(asking_);
  return recorder_ ? recorder_() : recording::RecorderState();
}

void LiveReplicate::beat() {
  const std::lock_guard lock(mutex_);
  beat_ = Steady::now();
}

std::optional<Trouble> LiveReplicate::trouble(Steady::time_point now) const {
  const recording::RecorderState recorder = recorder_state();
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < std::min(devices_.size(), recorder.disks.size()); ++i) {
    if (auto found = trouble_of(devices_[i]->live.name(), recorder.disks[i], now)) return found;
  }
  if (devices_.empty() || now - beat_ < kHangsAfter) return std::nullopt;
  return Trouble{"its recording makes no progress; check the devices and the disk", beat_, true};
}

void LiveReplicate::join(const v1::RecordedDevice& device) {
  const std::lock_guard lock(mutex_);
  devices_.push_back(std::make_shared<Watched>(device));
}

// The reader's own lock alone: devices do not wait for each other.
void LiveReplicate::take(std::size_t device, const recording::Block& block) {
  const std::shared_ptr<Watched> to = devices().at(device);
  const std::lock_guard lock(to->mutex);
  to->live.take(block);
}

void LiveReplicate::end() {
  watch({});
  const std::lock_guard lock(mutex_);
  devices_.clear();
}

std::vector<std::shared_ptr<LiveReplicate::Watched>> LiveReplicate::devices() const {
  const std::lock_guard lock(mutex_);
  return devices_;
}

std::optional<v1::LiveReplicate> LiveReplicate::state() const {
  std::unique_lock lock(mutex_);
  if (devices_.empty()) return std::nullopt;
  const auto devices = devices_;
  v1::LiveReplicate out = about_;
  lock.unlock();
  const recording::RecorderState recorder = recorder_state();
  const Steady::time_point now = Steady::now();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    v1::LiveDevice& to = *out.add_devices();
    {
      const std::lock_guard own(devices[i]->mutex);
      to = devices[i]->live.state();
    }
    if (i >= recorder.counts.size()) continue;
    for (const recording::StreamCounts& counts : recorder.counts[i]) {
      to.set_received(to.received() + counts.received);
      to.set_stored(to.stored() + counts.stored);
      to.set_discarded(to.discarded() + recording::refused_rows(counts.refused));
    }
    if (const auto found = trouble_of(to.device(), recorder.disks[i], now))
      to.set_disk_trouble(sentence(*found));
  }
  return out;
}

Result<v1::SampleRanges> LiveReplicate::samples(const v1::GetLiveSamplesRequest& request) const {
  for (const auto& one : devices()) {
    const std::lock_guard own(one->mutex);
    if (one->live.name() != request.device()) continue;
    auto out = one->live.samples(request);
    const std::lock_guard lock(mutex_);
    if (out) out->set_replicate(about_.replicate());
    return out;
  }
  return fail(
      fmt::format("campaign '{}' does not record a device '{}' now", campaign_, request.device()));
}

std::vector<std::string> LiveReplicate::new_warnings() {
  std::vector<std::string> out;
  std::set<std::string> holding;
  for (const auto& one : devices()) {
    std::unique_lock own(one->mutex);
    const auto [device, warnings] = std::pair(one->live.name(), one->live.warnings());
    own.unlock();
    for (const v1::LiveWarning& warning : warnings) {
      const std::string key = device + "/" + warning.stream() + "/" + warning.channel() + "/" +
                              std::to_string(warning.concern());
      holding.insert(key);
      const std::lock_guard lock(mutex_);
      if (!told_.contains(key)) out.push_back(device + ": " + warning.sentence());
    }
  }
  const std::lock_guard lock(mutex_);
  told_ = std::move(holding);
  return out;
}

LiveReplicate& LiveBoard::of(const std::string& campaign) {
  const std::lock_guard lock(mutex_);
  auto& out = campaigns_[campaign];
  if (!out) out = std::make_unique<LiveReplicate>(campaign);
  return *out;
}

std::optional<Trouble> LiveBoard::trouble(const std::string& campaign,
                                          Steady::time_point now) const {
  const std::lock_guard lock(mutex_);
  const auto found = campaigns_.find(campaign);
  return found == campaigns_.end() ? std::nullopt : found->second->trouble(now);
}

std::vector<v1::LiveReplicate> LiveBoard::state() const {
  std::vector<v1::LiveReplicate> out;
  const std::lock_guard lock(mutex_);
  for (const auto& [name, campaign] : campaigns_) {
    if (auto state = campaign->state()) out.push_back(std::move(*state));
  }
  return out;
}

Result<v1::SampleRanges> LiveBoard::samples(const v1::GetLiveSamplesRequest& request) const {
  const std::lock_guard lock(mutex_);
  const auto found = campaigns_.find(request.campaign());
  if (found == campaigns_.end())
    return fail(fmt::format("campaign '{}' does not record now", request.campaign()));
  return found->second->samples(request);
}

std::vector<std::string> LiveBoard::new_warnings() {
  std::vector<std::string> out;
  const std::lock_guard lock(mutex_);
  for (const auto& [name, campaign] : campaigns_) {
    for (const std::string& one : campaign->new_warnings()) out.push_back(name + ": " + one);
  }
  return out;
}

}  // namespace imunoise::live
