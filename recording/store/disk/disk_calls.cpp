#include "recording/store/disk/disk_calls.h"

namespace imunoise::recording {

using Steady = std::chrono::steady_clock;

DiskCalls::Watch::Watch(DiskCalls& of, std::string_view what, const std::filesystem::path& path)
    : of_(of) {
  const std::lock_guard guard(of_.mutex_);
  place_ = of_.calls_.insert(of_.calls_.end(), {what, path, Steady::now()});
}

DiskCalls::Watch::~Watch() {
  const std::lock_guard guard(of_.mutex_);
  of_.calls_.erase(place_);
}

void DiskCalls::Watch::progress() {
  const std::lock_guard guard(of_.mutex_);
  place_->since = Steady::now();
  of_.calls_.splice(of_.calls_.end(), of_.calls_, place_);
}

std::vector<DiskCall> DiskCalls::pending() const {
  const std::lock_guard guard(mutex_);
  return {calls_.begin(), calls_.end()};
}

}  // namespace imunoise::recording
