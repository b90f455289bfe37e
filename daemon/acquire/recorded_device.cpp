#include "daemon/acquire/recorded_device.h"

#include <algorithm>
#include <array>
#include <limits>

namespace imunoise::acquire {
namespace {

const char* dtype_of(drivers::NumberType type) {
  switch (type) {
    case drivers::NumberType::kInt16:
      return "<i2";
    case drivers::NumberType::kInt32:
      return "<i4";
    case drivers::NumberType::kInt64:
      return "<i8";
    case drivers::NumberType::kFloat32:
      return "<f4";
    case drivers::NumberType::kFloat64:
      break;
  }
  return "<f8";
}

// The counter as a recording can hold it; drivers may count further than it can.
bool counts(const drivers::Stream& stream) {
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  return stream.counter_maximum > 0 && stream.counter_maximum <= kMost;
}

// A recording keeps some names for itself.
std::string name_of(const drivers::Channel& channel) {
  const auto& taken = recording::kOwnColumns;
  const bool own = std::find(taken.begin(), taken.end(), channel.name) != taken.end();
  return own ? channel.name + "_channel" : channel.name;
}

recording::Refused reason_of(std::size_t reason) {
  switch (reason) {
    case IMUNOISE_REFUSED_CHECKSUM:
      return recording::Refused::kChecksum;
    case IMUNOISE_REFUSED_STALE:
      return recording::Refused::kStale;
    case IMUNOISE_REFUSED_OUT_OF_RANGE:
      return recording::Refused::kOutOfRange;
    case IMUNOISE_REFUSED_FAULT:
      return recording::Refused::kInvalid;
    case IMUNOISE_REFUSED_OVERRUN:
      return recording::Refused::kOverrun;
    default:
      return recording::Refused::kMalformed;
  }
}

// Every refused sample has one reason in every channel, or one in the channels to blame and
// IMUNOISE_REFUSED_SIBLING in the others.
std::vector<recording::Refusal> refusals_of(const drivers::SampleBlock& block) {
  const std::vector<drivers::Channel>& channels = block.stream().channels;
  std::uint64_t left = 0;  // samples not yet counted
  for (std::size_t k = 0; k < IMUNOISE_REFUSED_REASONS; ++k) left += block.refused(k, 0);
  std::vector<recording::Refusal> out;
  const auto count = [&](std::size_t reason, const std::string& channel, std::uint64_t samples) {
    const std::uint64_t taken = std::min(samples, left);
    if (taken > 0) recording::add_refusals(out, {{reason_of(reason), channel, taken}});
    left -= taken;
  };
  std::array<std::uint64_t, IMUNOISE_REFUSED_REASONS> whole{};
  for (std::size_t k = 0; k < IMUNOISE_REFUSED_REASONS; ++k) {
    if (k == IMUNOISE_REFUSED_SIBLING) continue;
    whole[k] = block.refused(k, 0);
    for (std::size_t c = 1; c < channels.size(); ++c) {
      whole[k] = std::min(whole[k], block.refused(k, c));
    }
    count(k, "", whole[k]);
  }
  for (std::size_t k = 0; k < IMUNOISE_REFUSED_REASONS; ++k) {
    if (k == IMUNOISE_REFUSED_SIBLING) continue;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      count(k, name_of(channels[c]), block.refused(k, c) - whole[k]);
    }
  }
  count(IMUNOISE_REFUSED_OTHER, "", left);  // of samples that no channel is to blame for
  return out;
}

}  // namespace

v1::RecordedDevice recorded_device(const std::string& name, const std::string& driver,
                                   const drivers::DeviceInfo& info) {
  v1::RecordedDevice out;
  out.set_name(name);
  out.set_driver(driver);
  out.set_serial(info.serial);
  if (!info.product.empty()) (*out.mutable_metadata())["product"] = info.product;
  if (!info.firmware.empty()) (*out.mutable_metadata())["firmware"] = info.firmware;
  for (const drivers::Stream& stream : info.streams) {
    v1::RecordedStream& to = *out.add_streams();
    to.set_name(stream.name);
    to.set_rate_hz(stream.nominal_rate_hz);
    if (counts(stream)) to.set_counter_modulus(stream.counter_maximum + 1);
    for (const drivers::Channel& channel : stream.channels) {
      v1::RecordedChannel& column = *to.add_channels();
      column.set_name(name_of(channel));
      column.set_dtype(dtype_of(channel.type));
      if (channel.units != "1") column.set_units(channel.units);
      if (channel.scale_factor != 1.0) column.set_scale_factor(channel.scale_factor);
      if (channel.add_offset != 0.0) column.set_add_offset(channel.add_offset);
      column.set_long_name(channel.long_name);
    }
  }
  return out;
}

recording::Block recorded_block(const drivers::SampleBlock& block) {
  recording::Block out{block.stream_index(), {}};
  recording::Rows& rows = out.rows;
  const auto times = block.host_time_ns();
  rows.host_time.assign(times.begin(), times.end());
  if (counts(block.stream())) {
    for (const std::uint64_t count : block.counter()) {
      rows.counter.push_back(static_cast<std::int64_t>(count));
    }
  }
  rows.refused = refusals_of(block);
  rows.received = block.rows() + recording::refused_rows(rows.refused);
  for (const std::uint32_t flags : block.flags()) {
    const bool lost = (flags & (IMUNOISE_SAMPLE_AFTER_GAP | IMUNOISE_SAMPLE_AFTER_RESTART)) != 0;
    rows.flags.push_back((flags & 0xFFFFU) | (lost ? recording::kLostBefore : 0U));
  }
  if (!rows.flags.empty() && !rows.refused.empty()) rows.flags.front() |= recording::kLostBefore;
  for (std::size_t c = 0; c < block.stream().channels.size(); ++c) {
    drivers::with_number_type(block.stream().channels[c].type, [&]<class Number>(Number) {
      const auto column = block.column<Number>(c);
      rows.channels.emplace_back(std::vector<Number>(column.begin(), column.end()));
    });
  }
  return out;
}

}  // namespace imunoise::acquire
