#include "drivers/replay/wire/wire_device.h"

namespace imunoise::replay {
namespace {

constexpr std::size_t kMostAtOnce = 4096;  // messages

}  // namespace

void WireDevice::read(plugin::Samples& samples, const plugin::Wait& wait) {
  if (!next_ns_) return samples.end();
  for (std::size_t taken = 0; next_ns_ && taken < kMostAtOnce; ++taken) {
    if (!timeline_.at_once()) {
      const auto due = timeline_.due(static_cast<double>(*next_ns_) * 1e-9);
      // What is due already comes together; only the first is waited for.
      if (taken > 0 && due > Timeline::Clock::now()) return;
      if (!wait.until(due)) return;
    }
    codec_->take(timeline_.host_time_ns(*next_ns_), samples);
    next_ns_ = codec_->next();
  }
}

}  // namespace imunoise::replay
