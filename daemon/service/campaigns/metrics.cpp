#include "daemon/service/campaigns/metrics.h"

#include <fmt/format.h>

#include <string_view>

namespace imunoise::service {
namespace {

using Labels = std::vector<std::pair<std::string_view, std::string>>;

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\n') {
      out += "\\n";
      continue;
    }
    if (c == '\\' || c == '"') out += '\\';
    out += c;
  }
  return out;
}

// One metric with all its samples.
class Family {
 public:
  Family(std::string& to, std::string_view name, std::string_view type, std::string_view help)
      : to_(to), name_(name) {
    to_ += fmt::format("# HELP {0} {1}\n# TYPE {0} {2}\n", name_, help, type);
  }
  template <class Number>
  Family& add(const Labels& labels, Number value) {
    std::string all;
    for (const auto& [name, text] : labels) {
      all += fmt::format("{}{}=\"{}\"", all.empty() ? "" : ",", name, escaped(text));
    }
    to_ += fmt::format("{}{} {}\n", name_, all.empty() ? "" : "{" + all + "}", value);
    return *this;
  }

 private:
  std::string& to_;
  std::string name_;
};

// Every value of an enumeration but the unspecified one: 1 for the one that holds.
template <class Add>
void for_each_phase(const v1::CampaignState& state, const Add& add) {
  const auto& phases = *v1::CampaignPhase_descriptor();
  for (int i = 1; i < phases.value_count(); ++i) {
    add(phases.value(i)->name(), phases.value(i)->number() == state.status().phase() ? 1 : 0);
  }
}

void add_campaigns(std::string& out, const Figures& figures) {
  Family phases(out, "imunoise_campaign_phase", "gauge", "1 for the current state of a campaign.");
  for (const v1::CampaignState& one : figures.campaigns) {
    for_each_phase(one, [&](const std::string& phase, int holds) {
      phases.add({{"campaign", one.campaign().name()}, {"phase", phase}}, holds);
    });
  }
  Family running(out, "imunoise_campaign_running", "gauge", "0: stopped, or finished.");
  for (const auto& one : figures.campaigns)
    running.add({{"campaign", one.campaign().name()}}, one.running() ? 1 : 0);
  Family troubled(out, "imunoise_campaign_troubled", "gauge",
                  "1: the disk fails or hangs, or the recording makes no progress.");
  for (const auto& one : figures.campaigns)
    troubled.add({{"campaign", one.campaign().name()}}, one.trouble().empty() ? 0 : 1);
  Family left(out, "imunoise_campaign_left_seconds", "gauge",
              "Time until the current recording is complete.");
  for (const auto& one : figures.campaigns) {
    if (one.has_left_s()) left.add({{"campaign", one.campaign().name()}}, one.left_s());
  }
  Family(out, "imunoise_campaign_files_rejected", "gauge",
         "Campaign files rejected when they were last read.")
      .add({}, figures.rejected_files);
  Family free(out, "imunoise_disk_free_bytes", "gauge", "Free space of the disk of a campaign.");
  for (const auto& [campaign, bytes] : figures.free_bytes)
    free.add({{"campaign", campaign}}, bytes);
}

// One family over the devices that are being recorded.
template <class Value>
void add_devices(std::string& out, const Figures& figures, std::string_view name,
                 std::string_view help, const Value& value) {
  Family family(out, name, "gauge", help);
  for (const v1::LiveReplicate& replicate : figures.live) {
    for (const v1::LiveDevice& one : replicate.devices()) {
      family.add({{"campaign", replicate.campaign()}, {"device", one.device()}}, value(one));
    }
  }
}

// All of the replicate under way.
void add_live(std::string& out, const Figures& figures) {
  using Device = v1::LiveDevice;
  add_devices(out, figures, "imunoise_device_received_samples",
              "Samples that the device delivered.",
              [](const Device& one) { return one.received(); });
  add_devices(out, figures, "imunoise_device_stored_samples", "Samples that are safe on disk.",
              [](const Device& one) { return one.stored(); });
  add_devices(out, figures, "imunoise_device_discarded_samples",
              "Samples that were received and will not be stored.",
              [](const Device& one) { return one.discarded(); });
  add_devices(out, figures, "imunoise_device_gaps", "Places where samples are missing.",
              [](const Device& one) { return one.gaps(); });
  add_devices(out, figures, "imunoise_device_last_sample_timestamp_seconds",
              "Time of the last sample; 0: no sample yet.",
              [](const Device& one) { return 1e-9 * static_cast<double>(one.last_sample_ns()); });
  add_devices(out, figures, "imunoise_device_disk_troubled",
              "1: the disk under the device's samples fails or hangs.",
              [](const Device& one) { return one.disk_trouble().empty() ? 0 : 1; });
}

void add_service(std::string& out, const Figures& figures) {
  const HttpCounters& http = figures.http;
  Family responses(out, "imunoise_http_responses_total", "counter", "Requests by status.");
  for (const auto& [status, count] : figures.responses)
    responses.add({{"status", std::to_string(status)}}, count);
  Family(out, "imunoise_http_connections", "gauge", "Open now.").add({}, http.connections);
  Family(out, "imunoise_http_event_streams", "gauge", "Open now.").add({}, http.streams);
  Family(out, "imunoise_http_accepted_total", "counter", "Connections.").add({}, http.accepted);
  Family(out, "imunoise_http_turned_away_total", "counter", "Connections beyond the limit.")
      .add({}, http.turned_away);
  Family(out, "imunoise_http_evicted_total", "counter",
         "Connections closed to make room: without a token, or idle.")
      .add({}, http.evicted);
  Family(out, "imunoise_http_timed_out_total", "counter", "Connections that were too slow.")
      .add({}, http.timed_out);
  Family(out, "imunoise_http_malformed_total", "counter", "Invalid or too large requests.")
      .add({}, http.malformed);
  Family(out, "imunoise_http_event_streams_dropped_total", "counter",
         "Event streams closed because their readers were too slow.")
      .add({}, http.streams_dropped);
}

void add_jobs(std::string& out, const Figures& figures) {
  std::map<v1::JobState, int> count{{v1::queued, 0}, {v1::working, 0}};
  for (const v1::Job& job : figures.jobs) {
    if (count.contains(job.state())) ++count[job.state()];
  }
  Family jobs(out, "imunoise_jobs", "gauge", "Waiting and running computations of studies.");
  for (const auto& [state, number] : count) jobs.add({{"state", v1::JobState_Name(state)}}, number);
}

}  // namespace

std::string metrics_text(const Figures& figures) {
  std::string out;
  Family(out, "imunoise_info", "gauge", "1; the version is the label.")
      .add({{"version", figures.version}}, 1);
  Family(out, "imunoise_uptime_seconds", "counter", "Time since imunoised began to serve.")
      .add({}, figures.uptime_s);
  add_campaigns(out, figures);
  add_live(out, figures);
  add_jobs(out, figures);
  add_service(out, figures);
  return out;
}

}  // namespace imunoise::service
