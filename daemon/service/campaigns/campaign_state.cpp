#include "daemon/service/campaigns/campaign_state.h"

#include <algorithm>
#include <optional>

namespace imunoise::service {
namespace {

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

// s, of so many replicates and the pauses between them.
double time_of(const v1::Campaign& campaign, double replicates) {
  return replicates * campaign.length_s() + std::max(0.0, replicates - 1.0) * campaign.pause_s();
}

// s; nothing where the status does not say how many replicates there are.
std::optional<double> time_left(const v1::Campaign& campaign, const v1::CampaignStatus& status,
                                std::int64_t now_ns) {
  const double all = campaign.replicates();
  if (status.phase() == v1::settling && status.recording().empty()) {
    return std::max(0.0, seconds(status.until_ns() - now_ns)) + time_of(campaign, all);
  }
  if (status.phase() != v1::recording) return std::nullopt;
  const double passed = std::max(0.0, seconds(now_ns - status.since_ns()));
  const double after = all - status.replicate();
  return std::max(0.0, campaign.length_s() - passed) +
         (after > 0.0 ? campaign.pause_s() + time_of(campaign, after) : 0.0);
}

}  // namespace

v1::CampaignState campaign_state(const CampaignSnapshot& campaign, std::int64_t now_ns) {
  v1::CampaignState out;
  *out.mutable_campaign() = campaign.campaign;
  *out.mutable_status() = campaign.status;
  out.mutable_status()->set_campaign(campaign.campaign.name());
  out.set_running(campaign.running);
  if (!campaign.running) return out;
  out.set_recording(recording_under_way(campaign.status));
  out.set_trouble(campaign.trouble);
  if (!campaign.trouble.empty()) return out;  // its end is unknown
  const auto left = time_left(campaign.campaign, campaign.status, now_ns);
  if (!left) return out;
  const double all =
      campaign.campaign.settling_s() + time_of(campaign.campaign, campaign.campaign.replicates());
  out.set_left_s(*left);
  if (all > 0.0) out.set_progress(std::clamp(1.0 - *left / all, 0.0, 1.0));
  return out;
}

}  // namespace imunoise::service
