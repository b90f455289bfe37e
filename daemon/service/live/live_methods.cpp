#include "daemon/service/live/live_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "daemon/service/api/figure_answer.h"
#include "imunoise/v1/service.pb.h"
#include "study/analysis/live_parameters.h"
#include "study/report/figures/live_figure.h"

namespace imunoise::service {
namespace {

constexpr double kPrecision = 0.1;

struct LiveOne {
  v1::LiveChannel channel;
  v1::LiveStream stream;
};

// The channel that a request names by campaign, device, stream and channel.
template <class Request>
Answer<LiveOne> live_one(const CampaignControl& control, const Request& request) {
  for (const v1::LiveReplicate& replicate : control.live()) {
    if (replicate.campaign() != request.campaign()) continue;
    for (const v1::LiveDevice& device : replicate.devices()) {
      if (device.device() != request.device()) continue;
      const auto is_meant = [&](const auto& one) { return one.stream() == request.stream(); };
      const auto stream = std::find_if(device.streams().begin(), device.streams().end(), is_meant);
      const auto channel = std::find_if(
          device.channels().begin(), device.channels().end(),
          [&](const auto& one) { return is_meant(one) && one.channel() == request.channel(); });
      if (stream != device.streams().end() && channel != device.channels().end())
        return LiveOne{*channel, *stream};
    }
  }
  return refuse(
      404, fmt::format("campaign '{}' records no channel '{}/{}/{}' now; GET /v1/live "
                       "lists those that it has",
                       request.campaign(), request.device(), request.stream(), request.channel()));
}

Answer<v1::Text> live_figure_of(const CampaignControl& control,
                                const v1::GetLiveFigureRequest& request) {
  const auto found = live_one(control, request);
  if (!found) return tl::unexpected(found.error());
  const auto figure = report::live_figure(found->channel);
  if (!figure) return refuse(404, "too few samples yet; ask again in a minute");
  return figure_answer(*figure, request);
}

Answer<v1::LiveParameters> live_parameters_of(const CampaignControl& control,
                                              const v1::GetLiveParametersRequest& request) {
  const double precision = request.precision() == 0.0 ? kPrecision : request.precision();
  if (!(precision >= 1e-3 && precision <= 1.0))
    return refuse(400, "precision: a fraction from 0.001 to 1");
  const auto found = live_one(control, request);
  if (!found) return tl::unexpected(found.error());
  auto out = study::live_parameters(found->channel, found->stream, request.model(), precision);
  if (!out) return refuse(400, out.error().message);
  return std::move(*out);
}

}  // namespace

void add_live_methods(Methods& methods, const CampaignControl& control) {
  methods.on<v1::GetLiveSamplesRequest>(
      [&control](const v1::GetLiveSamplesRequest& request) -> Answer<v1::SampleRanges> {
        auto out = control.samples(request);
        if (!out) return refuse(404, out.error().message);
        return std::move(*out);
      });
  methods.on<v1::GetLiveFigureRequest>([&control](const v1::GetLiveFigureRequest& request) {
    return live_figure_of(control, request);
  });
  methods.on_waiting<v1::GetLiveParametersRequest>(
      [&control](const v1::GetLiveParametersRequest& request) {
        return live_parameters_of(control, request);
      });
}

}  // namespace imunoise::service
