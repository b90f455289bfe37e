#include "daemon/app/last_resort.h"

#include <chrono>
#include <cstdlib>
#include <string>

namespace imunoise::app {
namespace {

constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::milliseconds kLookEvery{200};
constexpr int kNotClosed = 3;

}  // namespace

void LastResort::begin() {
  if (thread_.joinable()) return;
  thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

void LastResort::watch(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  const auto never = [] { return false; };
  over_.wait_for(lock, stop, kPatience, never);
  while (!stop.stop_requested()) {
    if (const std::string hanging = supervisor_.hanging(kPatience); !hanging.empty()) {
      log_.error(hanging);
      log_.error(
          "exits without closing recordings; acknowledged samples are in the "
          "journals, and the next start recovers them");
      std::_Exit(kNotClosed);
    }
    over_.wait_for(lock, stop, kLookEvery, never);
  }
}

}  // namespace imunoise::app
