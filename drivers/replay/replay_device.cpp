#include "drivers/replay/replay_device.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace imunoise::replay {
namespace {

// Samples added at once: large enough for speed, small enough for memory caches.
constexpr std::size_t kMostAtOnce = 4096;

drivers::Channel describe_channel(const recording::Channel& from) {
  drivers::Channel out;
  out.name = from.name;
  std::replace(out.name.begin(), out.name.end(), '/', '_');  // names become parts of files
  out.units = si_symbol(from.unit.quantity);
  out.type = std::visit(
      []<class Number>(const std::vector<Number>& /*type*/) {
        return drivers::number_type<Number>();
      },
      *from.samples);
  out.scale_factor = from.scale;
  out.add_offset = from.offset;
  return out;
}

}  // namespace

ReplayDevice::ReplayDevice(std::vector<recording::Replicate> replicates, Pace pace,
                           const plugin::Host& host)
    : replicates_(std::move(replicates)),
      timeline_(pace, host),
      rate_hz_(replicates_.front().rate.value) {}

drivers::DeviceInfo ReplayDevice::describe() {
  drivers::Stream stream;
  stream.name = "samples";
  stream.nominal_rate_hz = rate_hz_;
  stream.counter_maximum = UINT64_MAX;
  stream.device_time_tick_s = 1e-9;
  for (const recording::Channel& channel : replicates_.front().channels) {
    stream.channels.push_back(describe_channel(channel));
  }
  return {{std::move(stream)}, "replay"};
}

std::int64_t ReplayDevice::time_ns(std::size_t index) const {
  return std::llround(static_cast<double>(index) / rate_hz_ * 1e9);
}

// When that many samples are due.
plugin::Wait::Clock::time_point ReplayDevice::moment(std::size_t samples) const {
  return timeline_.due(static_cast<double>(samples) / rate_hz_);
}

// Samples that may be delivered now; waits for the next group.
std::size_t ReplayDevice::due(const plugin::Wait& wait) const {
  const std::size_t left = replicates_[replicate_].channels.front().count - next_;
  const std::size_t most = std::min(left, kMostAtOnce);
  if (timeline_.at_once()) return most;
  const double group = timeline_.pace().latency_s * timeline_.pace().speed * rate_hz_;
  const auto wanted = static_cast<std::size_t>(std::clamp(group, 1.0, static_cast<double>(most)));
  if (!wait.until(moment(sent_ + wanted))) return 0;
  std::size_t count = wanted;
  while (count < most && moment(sent_ + count + 1) <= plugin::Wait::Clock::now()) ++count;
  return count;
}

void ReplayDevice::read(plugin::Samples& samples, const plugin::Wait& wait) {
  if (replicate_ == replicates_.size()) return samples.end();
  const std::size_t count = due(wait);
  if (count == 0) return;
  const recording::Replicate& replicate = replicates_[replicate_];
  plugin::Rows rows = samples.add_many(0, count);
  const std::span<plugin::Stamp> stamps = rows.stamps();
  for (std::size_t i = 0; i < count; ++i) {
    stamps[i] = {timeline_.host_time_ns(time_ns(sent_ + i)), next_ + i, time_ns(next_ + i),
                 next_ + i == 0 ? std::uint32_t{IMUNOISE_SAMPLE_AFTER_RESTART} : 0U};
  }
  for (std::size_t c = 0; c < replicate.channels.size(); ++c) {
    const recording::Channel& channel = replicate.channels[c];
    const auto first = static_cast<std::ptrdiff_t>(channel.begin + next_);
    std::visit(
        [&]<class Number>(const std::vector<Number>& stored) {
          std::copy_n(stored.begin() + first, count, rows.column<Number>(c).begin());
        },
        *channel.samples);
  }
  sent_ += count;
  next_ += count;
  if (next_ == replicate.channels.front().count) {
    ++replicate_;
    next_ = 0;
  }
}

}  // namespace imunoise::replay
