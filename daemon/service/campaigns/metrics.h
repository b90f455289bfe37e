#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemon/service/http/http_server.h"
#include "imunoise/v1/service.pb.h"

namespace imunoise::service {

/// What is told to Prometheus.
struct Figures {
  std::string version;
  double uptime_s = 0.0;
  std::vector<v1::CampaignState> campaigns;
  std::size_t rejected_files = 0;                   ///< Of campaigns.
  std::map<std::string, std::uint64_t> free_bytes;  ///< Of each campaign's disk, where known.
  std::vector<v1::LiveReplicate> live;              ///< Replicates that are being recorded.
  std::vector<v1::Job> jobs;
  std::map<unsigned, std::uint64_t> responses;  ///< By status.
  HttpCounters http;
};

/// In its text format, version 0.0.4.
std::string metrics_text(const Figures& figures);

}  // namespace imunoise::service
