// Every method of the API, over a real socket.

#include <set>

#include "daemon/service/api/routes.h"
#include "imunoise/v1/service.pb.h"
#include "recording/store/disk/file_system.h"
#include "study/calibration/calibration_file.h"
#include "tests/daemon/service/served.h"

namespace imunoise {
namespace {

using namespace std::chrono_literals;
using testing::RawClient;
using testing::RawResponse;

class Api : public testing::Served {
 protected:
  v1::CampaignStatus recording_status() const {
    v1::CampaignStatus out;
    out.set_campaign("array");
    out.set_phase(v1::recording);
    out.set_recording("data/array/2026-03-01T060000Z");
    out.set_replicate(2);
    out.set_replicates(3);
    out.set_since_ns(1);
    return out;
  }
};

TEST_F(Api, DevicesAndDrivers) {
  drivers::Driver driver;
  driver.info.name = "replay";
  drivers_.found.push_back(driver);
  serve();
  control_.tell(recording_status());
  const json all = get_json("/v1/devices");
  ASSERT_EQ(all["devices"].size(), 2U);
  EXPECT_EQ(all["devices"][0]["device"]["name"], "imu-of-array");
  EXPECT_EQ(all["devices"][0]["recorded_now"], true);
  EXPECT_EQ(all["devices"][1]["recorded_now"], false);
  EXPECT_EQ(get_json("/v1/devices?campaign=other")["devices"].size(), 1U);
  EXPECT_EQ(refusal("/v1/devices?campaign=x", 404),
            "there is no campaign 'x'; there are array, other");
  EXPECT_EQ(get_json("/v1/drivers")["drivers"][0]["name"], "replay");
}

TEST_F(Api, CampaignsAreShownStartedAndStopped) {
  serve();
  EXPECT_EQ(get_json("/v1/campaigns")["campaigns"][1]["campaign"]["name"], "other");
  control_.tell(recording_status());
  const json array = get_json("/v1/campaigns/array");
  EXPECT_EQ(array["status"]["phase"], "recording");
  EXPECT_EQ(array["recording"], "2026-03-01T060000Z");
  EXPECT_EQ(array["left_s"], 100) << "one replicate, as this one is long over";
  EXPECT_FALSE(get_json("/v1/campaigns/other").contains("left_s"));
  EXPECT_EQ(post_json("/v1/campaigns/array/start", {{"once", true}})["campaign"]["name"], "array");
  post_json("/v1/campaigns/other/start", json::object());
  post_json("/v1/campaigns/other/stop", {{"recording", "2026-03-01T060000Z"}});
  EXPECT_EQ(post_json("/v1/campaigns/array/stop", {{"recording", "refuse"}}, 409)["error"],
            "not this one");
  for (const char* const verb : {"start", "stop"})
    post_json(std::string("/v1/campaigns/x/") + verb, json::object(), 404);
  EXPECT_EQ(control_.asked(),
            "start array once\nstart other\nstop other 2026-03-01T060000Z\nstop array refuse\n");
}

TEST_F(Api, CampaignsMayChangeWhileItServes) {
  serve();
  record("monday");
  EXPECT_EQ(get_json("/v1/recordings")["recordings"].size(), 1U);
  auto campaigns = control_.campaigns();
  campaigns.front().campaign.set_name("new");
  v1::RejectedFile rejected;
  rejected.set_file("bad.toml");
  rejected.add_problems("bad.toml:1:1: what is this?");
  control_.reload(campaigns, {rejected});
  const json all = get_json("/v1/campaigns");
  EXPECT_EQ(all["campaigns"][0]["campaign"]["name"], "new");
  EXPECT_EQ(all["rejected"][0]["file"], "bad.toml");
  EXPECT_EQ(all["rejected"][0]["problems"][0], "bad.toml:1:1: what is this?");
  const json recordings = get_json("/v1/recordings")["recordings"];
  ASSERT_EQ(recordings.size(), 1U) << "nothing is left of the campaign that has gone";
  EXPECT_EQ(recordings[0]["bench"], "new");
  get_json("/v1/recordings/new/monday");
  refusal("/v1/recordings/array/monday", 404);
  EXPECT_NE(testing::get(local_, "/metrics").body.find("imunoise_campaign_files_rejected 1\n"),
            std::string::npos);
}

TEST_F(Api, RecordingsAppearWhenTheyAreThere) {
  serve();
  EXPECT_TRUE(get_json("/v1/recordings")["recordings"].empty());
  record("monday");
  record("nested/tuesday");
  const json all = get_json("/v1/recordings");
  ASSERT_EQ(all["recordings"].size(), 2U);
  EXPECT_EQ(all["recordings"][0]["bench"], "array");
  EXPECT_EQ(get_json("/v1/recordings?campaign=array")["recordings"].size(), 2U);
  EXPECT_TRUE(get_json("/v1/recordings?campaign=other")["recordings"].empty());
  refusal("/v1/recordings?campaign=x", 404);
  for (const json& one : all["recordings"]) {
    const json manifest = get_json("/v1/recordings/array/" + one["folder"].get<std::string>());
    EXPECT_EQ(manifest["devices"][0]["serial"], "0042");
    EXPECT_EQ(manifest["chunks"].size(), 3U);
  }
  refusal("/v1/recordings/array/sunday", 404);
  refusal("/v1/recordings/x/monday", 404);
  refusal("/v1/recordings/array/nested", 404);
}

TEST_F(Api, FiguresOfHistories) {
  serve();
  const auto calibrate = [&](const std::string& name, double n) {
    v1::Calibration calibration;
    calibration.set_version(1);
    v1::ChannelCalibration& channel = *calibration.add_channels();
    channel.set_device("imu0");
    channel.set_stream("imu");
    channel.set_channel("gyro_x");
    v1::Term& term = *channel.mutable_fit()->add_terms();
    term.set_name("WN");
    v1::Coefficient& one = *term.add_coefficients();
    one.set_symbol("N");
    one.set_unit("rad/√s");
    one.set_value(n);
    one.set_lower(0.9 * n);
    one.set_upper(1.1 * n);
    ASSERT_TRUE(study::write_calibration(recording::posix_file_system(),
                                         folder_.path() / "data/array" / name, calibration));
  };
  const std::string of = "/v1/history/figure?device=0042&stream=imu&channel=gyro_x&term=WN";
  record("monday");
  calibrate("monday", 2e-3);
  EXPECT_NE(refusal(of + "&parameter=N", 404).find("once"), std::string::npos);
  record("tuesday", testing::kSimulatedStart + 86'400'000'000'000);
  calibrate("tuesday", 3e-3);
  ASSERT_TRUE(comes_to_be_told("/v1/history?device=0042", "tuesday"));
  const RawResponse response = get(local_, of + "&parameter=N&width=400");
  EXPECT_EQ(response.status, 200);
  EXPECT_NE(response.head.find("image/svg+xml"), std::string::npos);
  EXPECT_NE(response.body.find("data-y=\"0.003\""), std::string::npos) << response.body;
  EXPECT_NE(response.body.find("viewBox=\"0 0 400"), std::string::npos) << response.body;
  EXPECT_NE(refusal(of + "&parameter=K", 404).find("/v1/history"), std::string::npos);
  EXPECT_NE(refusal(of + "&parameter=N&width=100", 400).find("200"), std::string::npos);
  refusal("/v1/history/figure?device=7&parameter=N", 404);
}

TEST_F(Api, CalibrationsArraysAndHistories) {
  serve();
  record("monday");
  EXPECT_NE(refusal("/v1/calibrations/array/monday", 404).find("imunoise calibrate"),
            std::string::npos);
  v1::Calibration calibration;
  calibration.set_version(1);
  calibration.set_summary("well");
  calibration.add_arrays()->add_channels("gyro_x");
  v1::ArrayCalibration& across = *calibration.add_arrays();
  across.add_channels("a/imu/gyro_x");
  across.mutable_join()->add_streams()->set_clock_ppm(40.0);
  ASSERT_TRUE(study::write_calibration(recording::posix_file_system(),
                                       folder_.path() / "data/array/monday", calibration));
  EXPECT_EQ(get_json("/v1/calibrations")["calibrations"][0]["summary"], "well");
  EXPECT_TRUE(get_json("/v1/calibrations?campaign=other")["calibrations"].empty());
  EXPECT_EQ(get_json("/v1/calibrations/array/monday")["summary"], "well");
  EXPECT_EQ(get_json("/v1/arrays")["arrays"][0]["channels"][0], "gyro_x");
  EXPECT_EQ(get_json("/v1/arrays")["arrays"][1]["device"], "");
  const json arrays = get_json("/v1/arrays/array/monday")["arrays"];
  ASSERT_EQ(arrays.size(), 2U);
  EXPECT_FALSE(arrays[0].contains("join")) << "of one device";
  EXPECT_EQ(arrays[1]["join"]["streams"][0]["clock_ppm"], 40.0);
  EXPECT_NE(refusal("/v1/history?device=7", 404).find("simulated:0042"), std::string::npos);
  refusal("/v1/history", 400);
  refusal("/v1/history?device=0042&level=0.9", 400);
  EXPECT_NE(refusal("/v1/history?device=0042", 404).find("calibrate"), std::string::npos);
}

TEST_F(Api, EventsBeginWithWhatThereIs) {
  options_.tick = 50ms;
  serve();
  RawClient all(local_);
  all.send(testing::request_text("GET", "/v1/events"));
  EXPECT_NE(all.receive_until("\"other\"").find("event: campaign\ndata: {"), std::string::npos);
  RawClient jobs(local_);
  jobs.send(testing::request_text("GET", "/v1/events?topic=job"));
  jobs.receive_until("\r\n\r\n");
  control_.tell(recording_status());
  const std::string told = all.receive_until("\"left_s\":100");
  EXPECT_NE(told.find("\"recording\":\"2026-03-01T060000Z\""), std::string::npos) << told;
  record("monday");
  ASSERT_EQ(open_study("gyro")["state"], "done");
  const std::string of_jobs = jobs.receive_until("\"done\"");
  EXPECT_NE(of_jobs.find("event: job\ndata: {\"job\":\"job-1\""), std::string::npos) << of_jobs;
  EXPECT_NE(of_jobs.find("\"working\""), std::string::npos);
  EXPECT_EQ(of_jobs.find("campaign\ndata"), std::string::npos);
  EXPECT_EQ(of_jobs.find("\"attempts\""), std::string::npos) << "results are asked for";
  EXPECT_EQ(refusal("/v1/events?topic=weather", 400),
            "topic 'weather': there are campaign, job, live");
}

// One channel with so many scales.
v1::LiveReplicate live_replicate(int scales) {
  v1::LiveReplicate out;
  out.set_campaign("array");
  out.set_replicate(2);
  v1::LiveDevice& device = *out.add_devices();
  device.set_device("imu0");
  v1::LiveChannel& channel = *device.add_channels();
  channel.set_channel("gyro_x");
  for (int i = 0; i < scales; ++i) channel.add_scales()->set_tau_s(i + 1.0);
  return out;
}

TEST_F(Api, TellsWhatIsKnownWhileItRecords) {
  options_.tick = 50ms;
  serve();
  EXPECT_TRUE(get_json("/v1/live")["replicates"].empty());
  control_.show({live_replicate(3)});
  const auto known = get_json("/v1/live?campaign=array");
  EXPECT_EQ(known["replicates"][0]["devices"][0]["channels"][0]["scales"].size(), 3U) << known;
  EXPECT_EQ(get_json("/v1/live?device=imu0")["replicates"][0]["devices"].size(), 1U);
  EXPECT_TRUE(get_json("/v1/live?device=other")["replicates"][0]["devices"].empty());
  EXPECT_TRUE(get_json("/v1/live?campaign=other")["replicates"].empty());
  EXPECT_NE(refusal("/v1/live?campaign=none", 404).find("there is no campaign 'none'"),
            std::string::npos);
  RawClient client(local_);
  client.send(testing::request_text("GET", "/v1/events?topic=live"));
  const std::string told = client.receive_until("\"scales\":[]");
  EXPECT_NE(told.find("event: live\ndata: {"), std::string::npos);
  EXPECT_NE(told.find("\"gyro_x\""), std::string::npos);
}

TEST_F(Api, TimePassesInEventsWhileNothingChanges) {
  options_.tick = 50ms;
  serve();
  control_.tell(recording_status());
  RawClient client(local_);
  client.send(testing::request_text("GET", "/v1/events?topic=campaign"));
  std::string told = client.receive_until("\"other\"");
  const auto count = [](const std::string& text) {
    std::size_t out = 0;
    for (std::size_t at = 0; (at = text.find("event: campaign", at)) != std::string::npos; ++at)
      ++out;
    return out;
  };
  EXPECT_EQ(count(told), 2U);
  std::this_thread::sleep_for(300ms);
  told = client.receive_until("never", 50ms);
  EXPECT_GE(count(told), 4U);
}

// A line of the text format: a comment, or a name with labels and a number.
bool is_metric(const std::string& line) {
  if (line.starts_with("# HELP ") || line.starts_with("# TYPE ")) return true;
  const std::size_t blank = line.rfind(' ');
  if (blank == std::string::npos) return false;
  char* end = nullptr;
  std::strtod(line.c_str() + blank + 1, &end);
  const std::string name = line.substr(0, std::min(line.find('{'), blank));
  return *end == '\0' && name.starts_with("imunoise_") &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos &&
         (line[name.size()] == ' ' || line[blank - 1] == '}');
}

TEST_F(Api, MetricsAreWhatPrometheusReads) {
  serve();
  control_.tell(recording_status());
  get_json("/v1/campaigns");
  refusal("/nowhere", 404);
  const std::string room = "imunoise_disk_free_bytes{campaign=\"other\"} ";
  ASSERT_TRUE(comes_to_be_told("/metrics", room));
  const RawResponse response = testing::get(local_, "/metrics");
  EXPECT_NE(response.head.find("text/plain; version=0.0.4"), std::string::npos);
  std::istringstream lines(response.body);
  std::set<std::string> seen;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(is_metric(line)) << line;
    EXPECT_TRUE(seen.insert(line.substr(0, line.rfind(' '))).second || line.starts_with("#"))
        << line << ": twice";
  }
  for (const char* const line :
       {"imunoise_info{version=\"1.2.3\"} 1\n", "imunoise_http_responses_total{status=\"404\"} 1\n",
        "imunoise_campaign_phase{campaign=\"array\",phase=\"recording\"} 1\n",
        "imunoise_campaign_phase{campaign=\"array\",phase=\"waiting\"} 0\n",
        "imunoise_campaign_left_seconds{campaign=\"array\"} 100\n",
        "imunoise_jobs{state=\"queued\"} 0\n", room.c_str()})
    EXPECT_NE(response.body.find(line), std::string::npos) << line << response.body;
}

TEST_F(Api, ADiskThatHangsShows) {
  serve();
  control_.tell(recording_status());
  v1::LiveReplicate live;
  live.set_campaign("array");
  v1::LiveDevice& device = *live.add_devices();
  device.set_device("imu0");
  device.set_stored(60);
  device.set_last_sample_ns(1'772'323'200'500'000'000);
  device.set_disk_trouble("the disk hangs");
  control_.show({live});
  EXPECT_EQ(testing::get(local_, "/healthz").status, 200);
  control_.hold_up("the disk hangs: sync of /rec/a does not return");
  const RawResponse health = testing::get(local_, "/healthz");
  EXPECT_EQ(health.status, 503);
  EXPECT_NE(health.body.find("array"), std::string::npos) << health.body;
  EXPECT_EQ(health.body.find("/rec"), std::string::npos) << "anybody may ask";
  const json state = get_json("/v1/campaigns/array");
  EXPECT_EQ(state["trouble"], "the disk hangs: sync of /rec/a does not return");
  EXPECT_FALSE(state.contains("left_s")) << "nobody knows";
  const std::string metrics = testing::get(local_, "/metrics").body;
  for (const char* const line :
       {"imunoise_campaign_troubled{campaign=\"array\"} 1\n",
        "imunoise_campaign_troubled{campaign=\"other\"} 0\n",
        "imunoise_device_stored_samples{campaign=\"array\",device=\"imu0\"} 60\n",
        "imunoise_device_last_sample_timestamp_seconds{campaign=\"array\",device=\"imu0\"} "
        "1772323200.5\n",
        "imunoise_device_disk_troubled{campaign=\"array\",device=\"imu0\"} 1\n"})
    EXPECT_NE(metrics.find(line), std::string::npos) << line << metrics;
}

TEST_F(Api, TheDocumentDescribesEveryRoute) {
  serve();
  const json document = get_json("/openapi.json");
  EXPECT_EQ(document["openapi"], "3.0.3");
  EXPECT_EQ(document["info"]["version"], "1.2.3");
  const service::Routes routes(*v1::Refusal::descriptor()->file());
  EXPECT_GE(routes.all().size(), 25U);
  std::size_t operations = 0;
  for (const auto& [path, verbs] : document["paths"].items()) operations += verbs.size();
  EXPECT_EQ(operations, routes.all().size());
  const json& stop = document["paths"]["/v1/campaigns/{campaign}/stop"]["post"];
  EXPECT_EQ(stop["x-role"], "operator");
  EXPECT_EQ(stop["parameters"][0]["name"], "campaign");
  const json& body = stop["requestBody"]["content"]["application/json"]["schema"]["properties"];
  EXPECT_TRUE(body.contains("recording"));
  EXPECT_FALSE(body.contains("campaign")) << "the path says it";
  EXPECT_NE(body["recording"]["description"].get<std::string>().find("interrupted"),
            std::string::npos);
  EXPECT_TRUE(document["paths"]["/v1/recordings/{campaign}/{folder}"].contains("get"));
  const json& deletion = document["paths"]["/v1/studies/{study}"]["delete"];
  EXPECT_EQ(deletion["x-role"], "operator");
  EXPECT_FALSE(deletion.contains("requestBody"));
}

// Every reference leads to a schema, and every schema of a message is there once.
TEST_F(Api, TheDocumentHoldsTogether) {
  serve();
  const json document = get_json("/openapi.json");
  std::set<std::string> references;
  const std::function<void(const json&)> walk = [&](const json& node) {
    if (node.is_object() && node.contains("$ref"))
      references.insert(node["$ref"].get<std::string>());
    if (node.is_structured()) {
      for (const json& child : node) walk(child);
    }
  };
  walk(document);
  EXPECT_GE(references.size(), 30U);
  for (const std::string& one : references)
    EXPECT_TRUE(document.contains(json::json_pointer(one.substr(1)))) << one;
  EXPECT_EQ(document["components"]["schemas"].size(), references.size());
  const json& state = document["components"]["schemas"]["CampaignStatus"]["properties"];
  EXPECT_EQ(state["since_ns"]["allOf"][0]["type"], "string");
  EXPECT_NE(state["since_ns"]["description"].get<std::string>().find("nanoseconds"),
            std::string::npos);
}

TEST_F(Api, EveryRouteHasARoleASentenceAndAFunction) {
  serve();
  const service::Routes routes(*v1::Refusal::descriptor()->file());
  std::set<std::string> paths;
  for (const service::Route& route : routes.all()) {
    EXPECT_NE(route.http.role(), v1::role_unspecified) << route.path;
    EXPECT_TRUE(route.http.summary().ends_with(".")) << route.path;
    EXPECT_TRUE(route.path.starts_with("/")) << route.path;
    const bool shows_token = route.path == "/v1/session";  // who may, is what it finds out
    EXPECT_EQ(route.verb != "GET" && !shows_token, route.http.role() == v1::operator_)
        << route.path;
    EXPECT_TRUE(paths.insert(route.verb + route.path).second) << route.path << ": twice";
  }
  EXPECT_EQ(get_json("/healthz")["status"], "ok");
}

}  // namespace
}  // namespace imunoise
