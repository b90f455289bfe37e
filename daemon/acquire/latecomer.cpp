#include "daemon/acquire/latecomer.h"

#include <algorithm>
#include <utility>

namespace imunoise::acquire {

Latecomer::Latecomer(Open open, const Reopening& pauses)
    : open_(std::move(open)),
      pauses_(pauses),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

std::unique_ptr<drivers::Device> Latecomer::take() {
  const std::lock_guard lock(mutex_);
  return std::move(device_);
}

void Latecomer::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  auto pause = pauses_.first;
  while (!stopping_.wait_for(lock, stop, pause, [&] { return stop.stop_requested(); })) {
    pause = std::min(2 * pause, pauses_.longest);
    lock.unlock();
    auto opened = open_(stop);
    lock.lock();
    if (!opened) continue;
    device_ = std::move(*opened);
    return;
  }
}

}  // namespace imunoise::acquire
