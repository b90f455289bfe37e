#include "daemon/live/sample_rings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

namespace imunoise::live {
namespace {

constexpr std::uint64_t kRangesKept = 1024;  // ranges of a ring
constexpr std::uint32_t kRingFactor = 4;     // from one ring to the next
constexpr std::uint32_t kLargestRange = 4096;

std::string sizes() {
  std::string out;
  for (std::uint32_t size = 1; size <= kLargestRange; size *= kRingFactor)
    out += fmt::format("{}{}", size == 1 ? "" : ", ", size);
  return out;
}

}  // namespace

SampleRings::SampleRings(const v1::RecordedStream& stream) {
  for (const v1::RecordedChannel& one : stream.channels()) {
    channels_.push_back({one.name(), recording::units_of(one)});
  }
  newest_.resize(channels_.size());
  for (std::uint32_t size = 1; size <= kLargestRange; size *= kRingFactor) {
    Ring& ring = rings_.emplace_back();
    ring.samples_each = size;
    ring.times.resize(kRangesKept);
    ring.gaps.resize(kRangesKept);
    ring.extents.resize(kRangesKept * channels_.size());
  }
}

void SampleRings::push(Ring& ring, std::int64_t time, bool gap,
                       const std::vector<Extent>& values) const {
  const std::size_t place = ring.complete % kRangesKept;
  Extent* const to = ring.extents.data() + place * channels_.size();
  if (ring.held == 0) {
    ring.times[place] = time;
    ring.gaps[place] = gap;
    std::copy(values.begin(), values.end(), to);
  } else {
    if (gap) ring.gaps[place] = true;
    for (std::size_t c = 0; c < values.size(); ++c) {
      to[c].lower = std::min(to[c].lower, values[c].lower);
      to[c].upper = std::max(to[c].upper, values[c].upper);
    }
  }
  if (++ring.held < ring.samples_each) return;
  ring.held = 0;
  ++ring.complete;
}

void SampleRings::take(const recording::Rows& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      const double number = std::visit(
          [i](const auto& values) { return static_cast<double>(values[i]); }, rows.channels[c]);
      const auto value = static_cast<float>(channels_[c].units.value(number));
      if (std::isfinite(value)) newest_[c] = {value, value};
    }
    const bool gap = begin_ns_ && (rows.flags[i] & recording::kLostBefore) != 0;
    if (!begin_ns_) begin_ns_ = rows.host_time[i];
    for (Ring& ring : rings_) push(ring, rows.host_time[i], gap, newest_);
  }
}

Result<v1::SampleRanges> SampleRings::ranges(std::uint32_t samples_each, std::uint64_t from,
                                             const std::vector<std::string>& channels) const {
  const auto ring = std::find_if(rings_.begin(), rings_.end(), [&](const Ring& one) {
    return one.samples_each == std::max(1U, samples_each);
  });
  if (ring == rings_.end()) return fail("samples_each: one of " + sizes());
  std::vector<std::size_t> wanted;
  for (const std::string& name : channels) {
    const auto found = std::find_if(channels_.begin(), channels_.end(),
                                    [&](const Channel& one) { return one.name == name; });
    if (found == channels_.end()) return fail(fmt::format("channel '{}': there is none", name));
    wanted.push_back(static_cast<std::size_t>(found - channels_.begin()));
  }
  for (std::size_t c = 0; channels.empty() && c < channels_.size(); ++c) wanted.push_back(c);

  v1::SampleRanges out;
  out.set_samples_each(ring->samples_each);
  out.set_next(ring->complete);
  if (!begin_ns_) return out;
  out.set_begin_ns(*begin_ns_);
  for (const std::size_t c : wanted) {
    v1::RangeChannel& to = *out.add_channels();
    to.set_channel(channels_[c].name);
    to.set_units(channels_[c].units.symbol);
  }
  // The place of the range under way is one that is no longer kept.
  const std::uint64_t oldest = ring->complete - std::min(ring->complete, kRangesKept - 1);
  for (std::uint64_t k = std::max(from, oldest); k < ring->complete; ++k) {
    const std::size_t place = k % kRangesKept;
    if (ring->gaps[place]) out.add_gaps(static_cast<std::uint32_t>(out.time_s_size()));
    out.add_time_s(1e-9 * static_cast<double>(ring->times[place] - *begin_ns_));
    for (std::size_t c = 0; c < wanted.size(); ++c) {
      const Extent& extent = ring->extents[place * channels_.size() + wanted[c]];
      v1::RangeChannel& to = *out.mutable_channels(static_cast<int>(c));
      to.add_lower(extent.lower);
      to.add_upper(extent.upper);
    }
  }
  return out;
}

v1::RangeChannel SampleRings::last_minute(std::size_t channel, double rate_hz) const {
  constexpr double kMinute = 60.0;  // s
  constexpr double kFewest = 15.0;  // ranges
  auto ring = rings_.begin();
  while (std::next(ring) != rings_.end() &&
         kMinute * rate_hz >= kFewest * std::next(ring)->samples_each)
    ++ring;
  const auto wanted = static_cast<std::uint64_t>(std::ceil(kMinute * rate_hz / ring->samples_each));
  v1::RangeChannel out;
  out.set_channel(channels_[channel].name);
  out.set_units(channels_[channel].units.symbol);
  const std::uint64_t count = std::min({ring->complete, wanted, kRangesKept - 1});
  for (std::uint64_t k = ring->complete - count; k < ring->complete; ++k) {
    const Extent& extent = ring->extents[(k % kRangesKept) * channels_.size() + channel];
    out.add_lower(extent.lower);
    out.add_upper(extent.upper);
  }
  return out;
}

}  // namespace imunoise::live
