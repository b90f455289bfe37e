#pragma once

// A service on a Unix socket and on TCP, with two campaigns, one of which has recordings.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "daemon/service/service.h"
#include "tests/daemon/service/fake_campaign_control.h"
#include "tests/daemon/service/raw_client.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::testing {

class Served : public ::testing::Test {
 protected:
  using json = nlohmann::json;

  Served() {
    for (const char* const name : {"array", "other"}) {
      v1::Campaign campaign;
      campaign.set_name(name);
      campaign.set_folder((folder_.path() / "data" / name).string());
      campaign.set_replicates(3);
      campaign.set_length_s(100);
      v1::CampaignDevice& device = *campaign.add_devices();
      device.set_name("imu-of-" + std::string(name));
      device.set_driver("replay");
      control_.add(campaign);
      options_.freshness = std::chrono::milliseconds(0);
    }
    std::filesystem::create_directories(folder_.path() / "data/array");
    options_.listen = {folder_.path() / "api.sock", "127.0.0.1:0"};
    options_.studies = folder_.path() / "studies";
    options_.version = "1.2.3";
    options_.requests_per_second = 1e4;
    options_.burst = 1e4;
    options_.tokens = folder_.path() / "tokens";
    std::ofstream(*options_.tokens) << "viewer " << kViewer << "\noperator " << kOperator << "\n";
    ::chmod(options_.tokens->c_str(), 0600);
  }

  void serve() {
    auto started = service::Service::start(options_, {control_, drivers_, calls_});
    ASSERT_TRUE(started.has_value()) << started.error().message;
    service_ = std::move(*started);
    local_ = {*options_.listen.socket, 0};
    tcp_ = {"", service_->port()};
  }

  // Of the campaign "array".
  void record(const std::string& name, std::int64_t started_ns = testing::kSimulatedStart) const {
    SimulatedRecording what;
    what.folder = folder_.path() / "data/array" / name;
    std::filesystem::create_directories(what.folder.parent_path());
    what.channels = {{"gyro_x", "rad/s", "WN(sigma2=4e-6) + RW(gamma2=1e-9)"},
                     {"temperature", "K", "WN(sigma2=1e-4)"}};
    what.samples = 2048;
    what.started_ns = started_ns;
    testing::record(what);
  }

  json get_json(const std::string& target, int status = 200) const {
    const RawResponse response = get(local_, target);
    EXPECT_EQ(response.status, status) << target << ": " << response.body;
    return json::parse(response.body);
  }
  json post_json(const std::string& target, const json& body, int status = 200) const {
    const RawResponse response = post(local_, target, body.dump());
    EXPECT_EQ(response.status, status) << target << ": " << response.body;
    return json::parse(response.body);
  }
  json delete_json(const std::string& target, int status = 200) const {
    const RawResponse response = testing::send_one(local_, testing::request_text("DELETE", target));
    EXPECT_EQ(response.status, status) << target << ": " << response.body;
    return json::parse(response.body);
  }
  // A job's process steps back behind all others (nice 19): on a busy machine it gets a hundredth.
  json job_over(const std::string& id) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(10);
    for (;;) {
      json job = get_json("/v1/jobs/" + id);
      const std::string state = job["state"];
      if ((state != "queued" && state != "working") || std::chrono::steady_clock::now() > deadline)
        return job;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  // Asks for a job and waits for its end, however slow this machine is.
  json finished(const std::string& target, const json& body) const {
    return job_over(post_json(target, body, 202)["job"]);
  }
  json open_study(const std::string& name) const {
    return finished("/v1/studies", {{"study", name},
                                    {"campaign", "array"},
                                    {"folder", "monday"},
                                    {"channel", "gyro_x"},
                                    {"model", "WN"}});
  }
  // A response holds these words, soon.
  bool comes_to_be_told(const std::string& target, const std::string& words) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (get(local_, target).body.find(words) == std::string::npos) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
  }
  // The error of a response of this status.
  std::string refusal(const std::string& target, int status) const {
    return get_json(target, status)["error"];
  }

  static inline const std::string kViewer = std::string(32, 'v');
  static inline const std::string kOperator = std::string(32, 'o');
  const TemporaryFolder folder_;
  FakeCampaignControl control_;
  drivers::Drivers drivers_;
  recording::DiskCalls calls_;
  service::ServiceOptions options_;
  std::unique_ptr<service::Service> service_;
  Where local_;
  Where tcp_;
};

}  // namespace imunoise::testing
