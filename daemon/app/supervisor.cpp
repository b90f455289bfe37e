#include "daemon/app/supervisor.h"

#include <fmt/format.h>

#include "daemon/app/status_text.h"

namespace imunoise::app {

Supervisor::Supervisor(const std::vector<CampaignFile>& campaigns, const drivers::Drivers& drivers,
                       acquire::RunMode mode, Log& log)
    : log_(log),
      recorder_(recording::posix_file_system(), drivers,
                [this](const std::string& device, std::string_view text) {
                  log_.chatter(device, std::string(text));
                }),
      running_(campaigns.size()) {
  for (const CampaignFile& one : campaigns) {
    threads_.emplace_back([this, &one, mode] { run(one.campaign, mode); });
  }
}

Supervisor::~Supervisor() { stop(); }

void Supervisor::run(const v1::Campaign& campaign, acquire::RunMode mode) {
  acquire::CampaignSurroundings with{clock_, recording::posix_file_system(), recorder_};
  with.tell = [this](const v1::CampaignStatus& status) { take(status); };
  acquire::run_campaign(campaign, mode, with, source_.get_token());
  log_.fact(fmt::format("{}: ended", campaign.name()));
  --running_;
}

void Supervisor::take(const v1::CampaignStatus& status) {
  if (status.phase() == v1::held_up) {
    log_.warning(status_text(status));
  } else {
    log_.fact(status_text(status));
  }
  const std::lock_guard lock(mutex_);
  states_[status.campaign()] = status;
}

std::string Supervisor::status() const {
  const std::lock_guard lock(mutex_);
  std::string out;
  for (const auto& [name, state] : states_) out += (out.empty() ? "" : " | ") + status_text(state);
  return out;
}

}  // namespace imunoise::app
