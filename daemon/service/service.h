#pragma once

// The daemon's API: HTTP and JSON over a Unix socket and loopback TCP. docs/api.md is for its
// users.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "daemon/service/campaigns/campaign_control.h"
#include "daemon/service/http/http_server.h"
#include "daemon/service/studies/study_computation.h"
#include "drivers/host/load.h"
#include "imunoise/v1/campaign.pb.h"
#include "imunoise/v1/service.pb.h"
#include "recording/store/disk/disk_calls.h"

namespace imunoise::service {

struct ServiceOptions {
  Listen listen = {};
  std::optional<std::filesystem::path> tokens = {};  ///< File of those who come by TCP.
  std::vector<std::string> hosts = {};               ///< Names of this machine beside localhost.
  std::filesystem::path studies = "studies";         ///< Folder; made with the first study.
  std::string version = {};
  bool by_invitation = false;  ///< TCP without a file of tokens: for those whom invite() lets in.
  bool bench = true;           ///< It records; false: it shows files.
  std::vector<v1::NamedInput> inputs = {};  ///< Files that studies may be made of.
  /// Largest recording that is studied here, bytes of its chunks: what is read of it takes several
  /// times as much memory.
  std::uint64_t largest_study = std::uint64_t{256} << 20U;
  ComputeStudy compute = compute_here;        ///< What jobs do.
  std::chrono::milliseconds freshness{1000};  ///< Of lists of recordings.
  std::chrono::milliseconds tick{1000};  ///< From one event of a recording campaign to the next.
  std::size_t waiting_jobs = 16;
  double requests_per_second = 50.0;  ///< Of each peer, in the long run,
  double burst = 200.0;               ///< and at once.
  HttpLimits http = {};
};

/// What it is about.
struct ServiceSubjects {
  CampaignControl& control;  ///< The recordings of its campaigns are shown.
  const drivers::Drivers& drivers;
  recording::DiskCalls& calls;  ///< Its own are among them: a disk that hangs is told of there.
};

/// Serves while it lives.
class Service {
 public:
  /// The subjects outlive it. Error: of the listening (HttpServer), of the file of
  /// tokens, TCP without tokens.
  static Result<std::unique_ptr<Service>> start(const ServiceOptions& options,
                                                const ServiceSubjects& subjects);
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  std::uint16_t port() const;  ///< Of TCP; 0 without it.
  /// A token that opens one session of an operator, once.
  std::string invite();
  /// Clients that listen to events now.
  std::uint64_t listeners() const;

 private:
  class Implementation;
  explicit Service(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace imunoise::service
