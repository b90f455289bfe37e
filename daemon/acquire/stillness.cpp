#include "daemon/acquire/stillness.h"

#include <algorithm>

#include "core/support/units.h"

namespace imunoise::acquire {
namespace {

constexpr std::size_t kMostDisturbances = 1000;

bool watched(const v1::RecordedChannel& channel) {
  const auto unit = parse_unit(channel.units());
  return unit && of_inertia(unit->quantity);
}

double quantum_of(const v1::RecordedChannel& channel) {
  return channel.dtype().find('i') != std::string::npos ? 1.0 : 0.0;
}

}  // namespace

StillnessWatch::StillnessWatch(const v1::RecordedDevice& device) : device_(device) {
  for (const v1::RecordedStream& stream : device.streams()) {
    std::vector<std::size_t> channels;
    std::vector<double> quanta;
    for (int c = 0; c < stream.channels_size() && stream.rate_hz() > 0.0; ++c) {
      if (!watched(stream.channels(c))) continue;
      channels.push_back(static_cast<std::size_t>(c));
      quanta.push_back(quantum_of(stream.channels(c)));
    }
    streams_.push_back({std::move(channels), Stillness(Hertz{stream.rate_hz()}, quanta)});
  }
}

void StillnessWatch::take(const recording::Block& block) {
  Stream& stream = streams_[block.stream];
  if (stream.watch.empty()) return;
  const recording::Rows& rows = block.rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if ((rows.flags[i] & recording::kLostBefore) != 0) stream.watch.lost();
    for (std::size_t c = 0; c < stream.channels.size(); ++c) {
      std::visit(
          [&](const auto& numbers) { stream.watch.take(c, static_cast<double>(numbers[i])); },
          rows.channels[stream.channels[c]]);
    }
    stream.watch.end_row(rows.host_time[i]);
  }
}

std::vector<v1::Disturbance> StillnessWatch::disturbances() const {
  std::vector<v1::Disturbance> out;
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    const v1::RecordedStream& stream = device_.streams(static_cast<int>(s));
    for (const Disturbance& one : streams_[s].watch.found()) {
      v1::Disturbance& to = out.emplace_back();
      to.set_device(device_.name());
      to.set_begin_ns(one.begin);
      to.set_end_ns(one.end);
      to.set_size(one.size);
      to.set_channel(stream.channels(static_cast<int>(streams_[s].channels[one.channel])).name());
    }
  }
  return out;
}

std::vector<v1::Disturbance> merge_disturbances(std::vector<v1::Disturbance> all) {
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.begin_ns() < b.begin_ns(); });
  std::vector<v1::Disturbance> out;
  for (const v1::Disturbance& one : all) {
    if (out.empty() || one.begin_ns() > out.back().end_ns()) {
      out.push_back(one);
      continue;
    }
    v1::Disturbance& last = out.back();
    last.set_end_ns(std::max(last.end_ns(), one.end_ns()));
    if (one.size() > last.size()) {
      last.set_size(one.size());
      last.set_channel(one.channel());
    }
  }
  if (out.size() > kMostDisturbances) out.resize(kMostDisturbances);
  return out;
}

}  // namespace imunoise::acquire
