#pragma once

// So that no client keeps the service busy with requests alone.

#include <chrono>
#include <map>
#include <mutex>
#include <string>

namespace imunoise::service {

/// Each peer has a bucket of `burst` requests, which fills again with `per_second`. Thread-safe.
class RequestRate {
 public:
  using Time = std::chrono::steady_clock::time_point;

  RequestRate(double per_second, double burst) : per_second_(per_second), burst_(burst) {}

  /// False: it has to wait.
  bool pass(const std::string& peer, Time now);

 private:
  struct Bucket {
    double left;
    Time filled;
  };

  const double per_second_;
  const double burst_;
  std::mutex mutex_;
  std::map<std::string, Bucket> buckets_;  // one for each user of the machine, and one for TCP
};

}  // namespace imunoise::service
