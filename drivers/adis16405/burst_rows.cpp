#include "drivers/adis16405/burst_rows.h"

#include <array>
#include <cassert>
#include <string>
#include <utility>

namespace imunoise::drivers::adis16405 {
namespace {

using plugin::Reason;

struct StreamOfBurst {
  const char* name;
  std::uint16_t channels;
};
constexpr std::array kStreams = {StreamOfBurst{"imu", kInertialChannels},
                                 StreamOfBurst{"magnetometer", kMagneticChannels},
                                 StreamOfBurst{"housekeeping", kSlowChannels}};
constexpr std::size_t kImu = 0;

template <class Visitor>
void for_each_channel(unsigned channels, Visitor&& visitor) {
  for (std::size_t i = 0; i < kBurstChannels; ++i) {
    if ((channels >> i & 1U) != 0) visitor(i);
  }
}

// The outputs of 14 bits with a sign end there; the others cannot reach their ends.
bool saturated(std::int16_t counts) { return counts == -8192 || counts == 8191; }

}  // namespace

std::vector<Stream> describe_streams(const Settings& settings) {
  const auto scales = count_scales(settings.sensitivity_averaging);
  assert(scales);
  std::vector<Stream> out;
  for (const StreamOfBurst& from : kStreams) {
    Stream stream{from.name, {}, sample_rate(settings.sample_period).value};
    for_each_channel(from.channels, [&](std::size_t i) {
      const CountScale& scale = (*scales)[i];
      stream.channels.push_back({std::string(kChannelNames[i]), std::string(scale.unit),
                                 NumberType::kInt16, scale.scale, scale.offset});
    });
    out.push_back(std::move(stream));
  }
  return out;
}

BurstRows::BurstRows(bool poll) : poll_(poll) {
  for (const StreamOfBurst& stream : kStreams) {
    streams_.push_back({Gatherer(stream.channels), IMUNOISE_SAMPLE_AFTER_RESTART});
  }
}

void BurstRows::mark_gap() {
  for (State& stream : streams_) stream.next_flags |= IMUNOISE_SAMPLE_AFTER_GAP;
}

BurstRows::Taken BurstRows::take(Bytes bytes, std::int64_t host_time_ns, plugin::Samples& samples) {
  const auto burst = parse_burst(bytes);
  if (!burst) {
    refuse(Reason::kMalformed, samples);
    return {};
  }
  Taken out{false, burst->alarm != 0};
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    Gatherer& gatherer = streams_[s].gatherer;
    const Gathered gathered = gatherer.take(*burst);
    refuse(s, Reason::kMalformed, gatherer.take_lost(), samples);
    if (gathered == Gathered::kSample) add(s, host_time_ns, samples);
    if (gathered == Gathered::kSample && s == kImu) out.inertial = true;
    if (gathered == Gathered::kNothingNew) refuse(s, Reason::kStale, 1, samples);
  }
  return out;
}

void BurstRows::add(std::size_t stream, std::int64_t host_time_ns, plugin::Samples& samples) {
  const Burst& burst = streams_[stream].gatherer.sample();
  std::uint32_t flags = std::exchange(streams_[stream].next_flags, 0);
  if (burst.alarm != 0) flags |= IMUNOISE_SAMPLE_SUSPECT;
  for_each_channel(kStreams[stream].channels, [&](std::size_t i) {
    if (saturated(burst.counts[i])) flags |= IMUNOISE_SAMPLE_SATURATED;
  });
  plugin::Row row = samples.add(stream, {host_time_ns, 0, 0, flags});
  std::size_t column = 0;
  for_each_channel(kStreams[stream].channels,
                   [&](std::size_t i) { row.set(column++, burst.counts[i]); });
}

void BurstRows::refuse(plugin::Reason reason, plugin::Samples& samples) {
  for (std::size_t s = 0; s < streams_.size(); ++s) refuse(s, reason, 1, samples);
}

// Polling reads the same sample many times, so there a stale burst is no hole in the series.
void BurstRows::refuse(std::size_t stream, Reason reason, std::size_t count,
                       plugin::Samples& samples) {
  if (count == 0) return;
  samples.refuse(stream, reason, count);
  if (!poll_ || reason != Reason::kStale) {
    streams_[stream].next_flags |= IMUNOISE_SAMPLE_AFTER_GAP;
  }
}

}  // namespace imunoise::drivers::adis16405
