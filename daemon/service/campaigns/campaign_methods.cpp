#include "daemon/service/campaigns/campaign_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "daemon/acquire/clock.h"
#include "daemon/service/campaigns/campaign_state.h"
#include "daemon/service/campaigns/driver_report.h"
#include "imunoise/v1/service.pb.h"

namespace imunoise::service {
namespace {

Answer<CampaignSnapshot> campaign_called(const CampaignControl& control, const std::string& name) {
  std::string known;
  for (CampaignSnapshot& one : control.campaigns()) {
    if (one.campaign.name() == name) return std::move(one);
    known += (known.empty() ? "" : ", ") + one.campaign.name();
  }
  return refuse(404, fmt::format("there is no campaign '{}'; there are {}", name,
                                 known.empty() ? "none" : known));
}

Answer<v1::CampaignState> state_of(const CampaignControl& control, const std::string& name) {
  const auto found = campaign_called(control, name);
  if (!found) return tl::unexpected(found.error());
  return campaign_state(*found, acquire::now_ns());
}

// What became of the campaign, or why it refused.
Answer<v1::CampaignState> state_after(const CampaignControl& control, const std::string& name,
                                      const Result<void>& done) {
  if (!done) return refuse(409, done.error().message);
  return state_of(control, name);
}

v1::DeviceList devices_of(const CampaignControl& control, const std::string& campaign) {
  v1::DeviceList out;
  for (const CampaignSnapshot& one : control.campaigns()) {
    if (!campaign.empty() && one.campaign.name() != campaign) continue;
    for (const v1::CampaignDevice& device : one.campaign.devices()) {
      v1::BenchDevice& to = *out.add_devices();
      to.set_campaign(one.campaign.name());
      *to.mutable_device() = device;
      to.set_recorded_now(one.running && !recording_under_way(one.status).empty());
    }
  }
  return out;
}

}  // namespace

void add_campaign_methods(Methods& methods, CampaignControl& control,
                          const drivers::Drivers& drivers) {
  methods.on<v1::ListDevicesRequest>(
      [&control](const v1::ListDevicesRequest& request) -> Answer<v1::DeviceList> {
        if (!request.campaign().empty()) {
          if (const auto known = campaign_called(control, request.campaign()); !known)
            return tl::unexpected(known.error());
        }
        return devices_of(control, request.campaign());
      });
  methods.on<v1::ListDriversRequest>(
      [&drivers](const v1::ListDriversRequest&) -> Answer<v1::DriversReport> {
        return driver_report(drivers);
      });
  methods.on<v1::ListCampaignsRequest>(
      [&control](const v1::ListCampaignsRequest&) -> Answer<v1::CampaignList> {
        v1::CampaignList out;
        for (const CampaignSnapshot& one : control.campaigns()) {
          *out.add_campaigns() = campaign_state(one, acquire::now_ns());
        }
        for (v1::RejectedFile& one : control.rejected()) *out.add_rejected() = std::move(one);
        return out;
      });
  methods.on<v1::GetCampaignRequest>([&control](const v1::GetCampaignRequest& request) {
    return state_of(control, request.campaign());
  });
  methods.on<v1::GetLiveRequest>(
      [&control](const v1::GetLiveRequest& request) -> Answer<v1::LiveList> {
        if (!request.campaign().empty()) {
          if (const auto known = campaign_called(control, request.campaign()); !known)
            return tl::unexpected(known.error());
        }
        v1::LiveList out;
        for (v1::LiveReplicate& one : control.live()) {
          if (!request.campaign().empty() && one.campaign() != request.campaign()) continue;
          if (!request.device().empty()) {
            const auto others = std::remove_if(
                one.mutable_devices()->begin(), one.mutable_devices()->end(),
                [&](const v1::LiveDevice& each) { return each.device() != request.device(); });
            one.mutable_devices()->erase(others, one.mutable_devices()->end());
          }
          *out.add_replicates() = std::move(one);
        }
        return out;
      });
  methods.on<v1::StartCampaignRequest>(
      [&control](const v1::StartCampaignRequest& request) -> Answer<v1::CampaignState> {
        const auto known = campaign_called(control, request.campaign());
        if (!known) return tl::unexpected(known.error());
        return state_after(control, request.campaign(),
                           control.start(request.campaign(), request.once()));
      });
  methods.on<v1::StopCampaignRequest>(
      [&control](const v1::StopCampaignRequest& request) -> Answer<v1::CampaignState> {
        const auto known = campaign_called(control, request.campaign());
        if (!known) return tl::unexpected(known.error());
        return state_after(control, request.campaign(),
                           control.stop(request.campaign(), request.recording()));
      });
}

}  // namespace imunoise::service
