#include "daemon/service/service.h"

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include "daemon/acquire/clock.h"
#include "daemon/service/api/api_handler.h"
#include "daemon/service/api/openapi.h"
#include "daemon/service/campaigns/campaign_methods.h"
#include "daemon/service/campaigns/campaign_state.h"
#include "daemon/service/campaigns/free_space.h"
#include "daemon/service/campaigns/metrics.h"
#include "daemon/service/event_hub.h"
#include "daemon/service/exports/export_methods.h"
#include "daemon/service/live/live_methods.h"
#include "daemon/service/recordings/record_methods.h"
#include "daemon/service/studies/study_methods.h"

namespace imunoise::service {
namespace {

Result<ApiHandlerOptions> handler_options(const ServiceOptions& options) {
  ApiHandlerOptions out;
  out.hosts = options.hosts;
  out.requests_per_second = options.requests_per_second;
  out.burst = options.burst;
  out.version = options.version;
  out.bench = options.bench;
  if (options.tokens) {
    auto tokens = Tokens::read(*options.tokens);
    if (!tokens) return tl::unexpected(tokens.error());
    out.tokens = std::move(*tokens);
  } else if (options.listen.address && !options.by_invitation) {
    return fail(
        "TCP needs a file of tokens: every user of this machine can reach it (--tokens FILE)");
  }
  return out;
}

std::vector<v1::Campaign> campaigns_of(const CampaignControl& control) {
  std::vector<v1::Campaign> out;
  for (CampaignSnapshot& one : control.campaigns()) out.push_back(std::move(one.campaign));
  return out;
}

}  // namespace

class Service::Implementation {
 public:
  Implementation(const ServiceOptions& options, const ServiceSubjects& subjects,
                 std::unique_ptr<Records> records, ApiHandlerOptions how)
      : options_(options),
        control_(subjects.control),
        free_space_(subjects.control, subjects.calls),
        records_(std::move(records)),
        studies_(options.studies, subjects.calls),
        routes_(*v1::Refusal::descriptor()->file()),
        jobs_(options.waiting_jobs, [this](const v1::Job& job) { tell(job); }) {
    add_campaign_methods(methods_, control_, subjects.drivers);
    add_live_methods(methods_, control_);
    add_record_methods(methods_, *records_);
    add_study_methods(methods_, {jobs_, studies_, *records_, options_.inputs},
                      options.largest_study, options.compute);
    add_export_methods(methods_, *records_, studies_);
    add_own_methods();
    handler_.emplace(routes_, methods_, std::move(how));
  }
  ~Implementation() {
    control_.watch({});
    server_.reset();
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  Result<void> serve() {
    auto server = HttpServer::start(options_.listen, options_.http, *handler_);
    if (!server) return tl::unexpected(server.error());
    {
      const std::lock_guard lock(server_mutex_);
      server_ = std::move(*server);
    }
    control_.watch([this](const std::string& campaign) { tell(campaign); });
    ticker_ = std::jthread([this](const std::stop_token& stop) { tick(stop); });
    return {};
  }

  std::uint16_t port() const { return server_->port(); }
  std::string invite() { return handler_->invite(); }
  std::uint64_t listeners() const { return server_->counters().streams; }

 private:
  void add_own_methods() {
    methods_.on<v1::WatchRequest>(
        [this](const v1::WatchRequest& request) -> Answer<std::shared_ptr<EventQueue>> {
          auto queue = hub_.subscribe({request.topic().begin(), request.topic().end()},
                                      [this] { return everything(); });
          if (!queue) return refuse(400, queue.error().message);
          return std::move(*queue);
        });
    methods_.on<v1::GetHealthRequest>([this](const v1::GetHealthRequest&) -> Answer<v1::Health> {
      // Anybody may ask: names, but no places.
      std::string held_up;
      for (const CampaignSnapshot& one : control_.campaigns()) {
        if (one.trouble.empty()) continue;
        held_up += (held_up.empty() ? "" : ", ") + one.campaign.name();
      }
      if (!control_.trouble().empty()) return refuse(503, "a disk hangs; the log tells which");
      if (!held_up.empty())
        return refuse(503, "cannot record: " + held_up + "; GET /v1/campaigns shows why");
      v1::Health out;
      out.set_status("ok");
      out.set_version(options_.version);
      return out;
    });
    methods_.on<v1::GetMetricsRequest>([this](const v1::GetMetricsRequest&) -> Answer<v1::Text> {
      v1::Text out;
      out.set_text(metrics_text(figures()));
      return out;
    });
    methods_.on<v1::GetDocumentRequest>([this](const v1::GetDocumentRequest&) -> Answer<v1::Text> {
      v1::Text out;
      out.set_text(openapi_document(routes_, options_.version));
      return out;
    });
  }

  Figures figures() const {
    Figures out;
    out.version = options_.version;
    out.uptime_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    for (const CampaignSnapshot& one : control_.campaigns()) {
      out.campaigns.push_back(campaign_state(one, acquire::now_ns()));
    }
    out.free_bytes = free_space_.known();
    out.rejected_files = control_.rejected().size();
    out.live = control_.live();
    out.jobs = jobs_.list();
    out.responses = handler_->responses();
    const std::lock_guard lock(server_mutex_);
    if (server_) out.http = server_->counters();
    return out;
  }

  std::vector<v1::Event> everything() const {
    std::vector<v1::Event> out;
    for (const CampaignSnapshot& one : control_.campaigns()) {
      *out.emplace_back().mutable_campaign() = campaign_state(one, acquire::now_ns());
    }
    for (const v1::Job& job : jobs_.list()) *out.emplace_back().mutable_job() = job;
    return out;
  }

  void tell(const v1::Job& job) {
    v1::Event event;
    *event.mutable_job() = job;
    hub_.tell(event);
  }
  void tell(const CampaignSnapshot& campaign) {
    v1::Event event;
    *event.mutable_campaign() = campaign_state(campaign, acquire::now_ns());
    hub_.tell(event);
  }
  void tell(v1::LiveReplicate live) {
    // They are most of it and change slowly: GET /v1/live has them.
    for (v1::LiveDevice& device : *live.mutable_devices()) {
      for (v1::LiveChannel& channel : *device.mutable_channels()) channel.clear_scales();
    }
    v1::Event event;
    *event.mutable_live() = std::move(live);
    hub_.tell(event);
  }
  void tell(const std::string& campaign) {
    for (const CampaignSnapshot& one : control_.campaigns()) {
      if (one.campaign.name() == campaign) tell(one);
    }
  }

  // Time passes while nothing changes.
  void tick(const std::stop_token& stop) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any stopping;
    while (!stopping.wait_for(lock, stop, options_.tick, [&] { return stop.stop_requested(); })) {
      if (hub_.wanted("campaign")) {
        for (const CampaignSnapshot& one : control_.campaigns()) {
          if (one.running && !recording_under_way(one.status).empty()) tell(one);
        }
      }
      if (hub_.wanted("live")) {
        for (v1::LiveReplicate& one : control_.live()) tell(std::move(one));
      }
    }
  }

  const ServiceOptions options_;
  CampaignControl& control_;
  const std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  FreeSpace free_space_;
  EventHub hub_;
  std::unique_ptr<Records> records_;
  StudyStore studies_;
  Routes routes_;
  Methods methods_;
  Jobs jobs_;  // after the methods: its thread runs their code
  std::optional<ApiHandler> handler_;
  mutable std::mutex server_mutex_;  // its first requests may come before it is known here
  std::unique_ptr<HttpServer> server_;
  std::jthread ticker_;  // last: it uses all of the above
};

Service::Service(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Service::~Service() = default;

Result<std::unique_ptr<Service>> Service::start(const ServiceOptions& options,
                                                const ServiceSubjects& subjects) {
  auto how = handler_options(options);
  if (!how) return tl::unexpected(how.error());
  auto records = Records::open([&control = subjects.control] { return campaigns_of(control); },
                               options.freshness, subjects.calls, options.largest_study);
  if (!records) return tl::unexpected(records.error());
  auto out =
      std::make_unique<Implementation>(options, subjects, std::move(*records), std::move(*how));
  if (auto done = out->serve(); !done) return tl::unexpected(done.error());
  return std::unique_ptr<Service>(new Service(std::move(out)));
}

std::uint16_t Service::port() const { return implementation_->port(); }
std::string Service::invite() { return implementation_->invite(); }
std::uint64_t Service::listeners() const { return implementation_->listeners(); }

}  // namespace imunoise::service
