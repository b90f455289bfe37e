#pragma once

// Acquisition for tests of the service: it does what it is told, and remembers it.

#include <mutex>

#include "daemon/service/campaigns/campaign_control.h"

namespace imunoise::testing {

class FakeCampaignControl : public service::CampaignControl {
 public:
  std::vector<service::CampaignSnapshot> campaigns() const override {
    const std::lock_guard lock(mutex_);
    return campaigns_;
  }
  std::vector<v1::RejectedFile> rejected() const override {
    const std::lock_guard lock(mutex_);
    return rejected_;
  }
  std::vector<v1::LiveReplicate> live() const override {
    const std::lock_guard lock(mutex_);
    return live_;
  }
  Result<v1::SampleRanges> samples(const v1::GetLiveSamplesRequest& request) const override {
    const std::lock_guard lock(mutex_);
    if (request.device() != samples_of_) return fail("no such device");
    return samples_;
  }
  std::string trouble() const override { return ""; }
  Result<void> start(const std::string& campaign, bool once) override {
    const std::lock_guard lock(mutex_);
    asked_ += "start " + campaign + (once ? " once\n" : "\n");
    return {};
  }
  Result<void> stop(const std::string& campaign, const std::string& recording) override {
    const std::lock_guard lock(mutex_);
    asked_ += "stop " + campaign + " " + recording + "\n";
    if (recording == "refuse") return fail("not this one");
    return {};
  }
  void watch(Watcher changed) override {
    const std::lock_guard lock(watching_);
    watcher_ = std::move(changed);
  }

  void add(const v1::Campaign& campaign) { campaigns_.push_back({campaign, {}, true}); }
  /// These are the campaigns from now on.
  void reload(std::vector<service::CampaignSnapshot> campaigns,
              std::vector<v1::RejectedFile> rejected) {
    const std::lock_guard lock(mutex_);
    campaigns_ = std::move(campaigns);
    rejected_ = std::move(rejected);
  }
  /// The first campaign does this from now on.
  void tell(const v1::CampaignStatus& status) {
    std::string name;
    {
      const std::lock_guard lock(mutex_);
      campaigns_.front().status = status;
      name = campaigns_.front().campaign.name();
    }
    const std::lock_guard lock(watching_);
    if (watcher_) watcher_(name);
  }
  /// The first campaign cannot record.
  void hold_up(const std::string& trouble) {
    const std::lock_guard lock(mutex_);
    campaigns_.front().trouble = trouble;
  }
  void show(std::vector<v1::LiveReplicate> live) {
    const std::lock_guard lock(mutex_);
    live_ = std::move(live);
  }
  /// What is told of one device's latest samples.
  void show(const std::string& device, v1::SampleRanges samples) {
    const std::lock_guard lock(mutex_);
    samples_of_ = device;
    samples_ = std::move(samples);
  }
  /// What clients asked for, a line each.
  std::string asked() const {
    const std::lock_guard lock(mutex_);
    return asked_;
  }

 private:
  mutable std::mutex mutex_;
  std::mutex watching_;
  std::vector<service::CampaignSnapshot> campaigns_;
  std::vector<v1::RejectedFile> rejected_;
  std::vector<v1::LiveReplicate> live_;
  std::string samples_of_;
  v1::SampleRanges samples_;
  std::string asked_;
  Watcher watcher_;
};

}  // namespace imunoise::testing
