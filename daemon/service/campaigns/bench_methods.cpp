#include "daemon/service/campaigns/bench_methods.h"

#include <fmt/format.h>

#include <optional>

#include "daemon/acquire/clock.h"
#include "daemon/service/campaigns/campaign_state.h"
#include "daemon/service/campaigns/driver_report.h"
#include "imunoise/v1/service.pb.h"

namespace imunoise::service {
namespace {

Answer<BenchCampaign> campaign_called(const Bench& bench, const std::string& name) {
  std::string known;
  for (BenchCampaign& one : bench.campaigns()) {
    if (one.campaign.name() == name) return std::move(one);
    known += (known.empty() ? "" : ", ") + one.campaign.name();
  }
  return refuse(404, fmt::format("there is no campaign '{}'; there are {}", name,
                                 known.empty() ? "none" : known));
}

Answer<v1::CampaignState> state_of(const Bench& bench, const std::string& name) {
  const auto found = campaign_called(bench, name);
  if (!found) return tl::unexpected(found.error());
  return campaign_state(*found, acquire::now_ns());
}

// What became of the campaign, or why it refused.
Answer<v1::CampaignState> state_after(const Bench& bench, const std::string& name,
                                      const Result<void>& done) {
  if (!done) return refuse(409, done.error().message);
  return state_of(bench, name);
}

v1::DeviceList devices_of(const Bench& bench, const std::string& campaign) {
  v1::DeviceList out;
  for (const BenchCampaign& one : bench.campaigns()) {
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

void add_bench_methods(Methods& methods, Bench& bench, const drivers::Drivers& drivers) {
  methods.on<v1::ListDevicesRequest>(
      [&bench](const v1::ListDevicesRequest& request) -> Answer<v1::DeviceList> {
        if (!request.campaign().empty()) {
          if (const auto known = campaign_called(bench, request.campaign()); !known)
            return tl::unexpected(known.error());
        }
        return devices_of(bench, request.campaign());
      });
  methods.on<v1::ListDriversRequest>(
      [&drivers](const v1::ListDriversRequest&) -> Answer<v1::DriversReport> {
        return driver_report(drivers);
      });
  methods.on<v1::ListCampaignsRequest>(
      [&bench](const v1::ListCampaignsRequest&) -> Answer<v1::CampaignList> {
        v1::CampaignList out;
        for (const BenchCampaign& one : bench.campaigns()) {
          *out.add_campaigns() = campaign_state(one, acquire::now_ns());
        }
        for (v1::RejectedFile& one : bench.rejected()) *out.add_rejected() = std::move(one);
        return out;
      });
  methods.on<v1::GetCampaignRequest>([&bench](const v1::GetCampaignRequest& request) {
    return state_of(bench, request.campaign());
  });
  methods.on<v1::GetLiveRequest>(
      [&bench](const v1::GetLiveRequest& request) -> Answer<v1::LiveList> {
        if (!request.campaign().empty()) {
          if (const auto known = campaign_called(bench, request.campaign()); !known)
            return tl::unexpected(known.error());
        }
        v1::LiveList out;
        for (v1::LiveReplicate& one : bench.live()) {
          if (request.campaign().empty() || one.campaign() == request.campaign())
            *out.add_replicates() = std::move(one);
        }
        return out;
      });
  methods.on<v1::StartCampaignRequest>(
      [&bench](const v1::StartCampaignRequest& request) -> Answer<v1::CampaignState> {
        const auto known = campaign_called(bench, request.campaign());
        if (!known) return tl::unexpected(known.error());
        return state_after(bench, request.campaign(),
                           bench.start(request.campaign(), request.once()));
      });
  methods.on<v1::StopCampaignRequest>(
      [&bench](const v1::StopCampaignRequest& request) -> Answer<v1::CampaignState> {
        const auto known = campaign_called(bench, request.campaign());
        if (!known) return tl::unexpected(known.error());
        return state_after(bench, request.campaign(),
                           bench.stop(request.campaign(), request.recording()));
      });
}

}  // namespace imunoise::service
