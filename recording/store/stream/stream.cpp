#include "recording/store/stream/stream.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <set>
#include <utility>

namespace imunoise::recording {
namespace {

constexpr std::uint64_t kLargestModulus = std::uint64_t{1} << 63U;  // counters are int64

constexpr std::array<std::pair<Refused, std::string_view>, 7> kWords = {{
    {Refused::kChecksum, "checksum"},
    {Refused::kStale, "stale"},
    {Refused::kOutOfRange, "out_of_range"},
    {Refused::kMalformed, "malformed"},
    {Refused::kInvalid, "invalid"},
    {Refused::kOverrun, "overrun"},
    {Refused::kNotWritten, "not_written"},
}};

// A name becomes a file or an HDF5 object: plain characters, and none that climbs out of a folder.
Result<void> check_name(std::string_view what, const std::string& name,
                        std::set<std::string>& taken) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  if (name.empty() || name.size() > 64 || name.front() == '.' ||
      !std::all_of(name.begin(), name.end(), plain)) {
    return fail(fmt::format(
        "{} name '{}' is not usable: 1 to 64 letters, digits, '_', '-' or '.', no '.' in front",
        what, name));
  }
  if (!taken.insert(name).second) return fail(fmt::format("two {}s are named '{}'", what, name));
  return {};
}

Result<void> check_channel(const v1::RecordedChannel& channel) {
  const double scale = channel.has_scale_factor() ? channel.scale_factor() : 1.0;
  if (!numbers_of_type(channel.dtype())) {
    return fail(fmt::format("channel {}: dtype '{}' is none of <i2, <i4, <i8, <f4, <f8",
                            channel.name(), channel.dtype()));
  }
  if (!std::isfinite(scale) || scale == 0.0 || !std::isfinite(channel.add_offset())) {
    return fail(
        fmt::format("channel {}: scale_factor {} and add_offset {} must be finite, the factor not "
                    "0",
                    channel.name(), scale, channel.add_offset()));
  }
  if (!std::isfinite(channel.valid_min()) || !std::isfinite(channel.valid_max())) {
    return fail(fmt::format("channel {}: valid_min and valid_max must be finite", channel.name()));
  }
  return {};
}

}  // namespace

std::optional<Numbers> numbers_of_type(std::string_view dtype) {
  if (dtype == "<i2") return std::vector<std::int16_t>();
  if (dtype == "<i4") return std::vector<std::int32_t>();
  if (dtype == "<i8") return std::vector<std::int64_t>();
  if (dtype == "<f4") return std::vector<float>();
  if (dtype == "<f8") return std::vector<double>();
  return std::nullopt;
}

std::size_t size(const Numbers& numbers) {
  return std::visit([](const auto& values) { return values.size(); }, numbers);
}

void append(Numbers& to, const Numbers& from) {
  std::visit(
      [&](auto& values) {
        const auto& more = std::get<std::decay_t<decltype(values)>>(from);
        values.insert(values.end(), more.begin(), more.end());
      },
      to);
}

std::string_view word(Refused reason) {
  const auto found = std::find_if(kWords.begin(), kWords.end(),
                                  [&](const auto& entry) { return entry.first == reason; });
  assert(found != kWords.end());
  return found->second;
}

std::optional<Refused> refused_from_word(std::string_view text) {
  const auto found = std::find_if(kWords.begin(), kWords.end(),
                                  [&](const auto& entry) { return entry.second == text; });
  if (found == kWords.end()) return std::nullopt;
  return found->first;
}

void add_refusals(std::vector<Refusal>& to, const std::vector<Refusal>& from) {
  for (const Refusal& one : from) {
    const auto same = std::find_if(to.begin(), to.end(), [&](const Refusal& other) {
      return other.reason == one.reason && other.channel == one.channel;
    });
    if (same != to.end()) {
      same->rows += one.rows;
    } else {
      to.push_back(one);
    }
  }
}

std::uint64_t refused_rows(const std::vector<Refusal>& refusals) {
  std::uint64_t sum = 0;
  for (const Refusal& one : refusals) sum += one.rows;
  return sum;
}

Rows empty_rows(const v1::RecordedStream& stream) {
  Rows out;
  for (const v1::RecordedChannel& channel : stream.channels()) {
    out.channels.push_back(*numbers_of_type(channel.dtype()));
  }
  return out;
}

void append(Rows& to, const Rows& from) {
  const auto add = [](auto& values, const auto& more) {
    values.insert(values.end(), more.begin(), more.end());
  };
  add(to.host_time, from.host_time);
  add(to.counter, from.counter);
  add(to.flags, from.flags);
  for (std::size_t i = 0; i < to.channels.size(); ++i) append(to.channels[i], from.channels[i]);
  to.received += from.received;
  add_refusals(to.refused, from.refused);
}

Result<void> check_device(const v1::RecordedDevice& device) {
  std::set<std::string> no_others;
  if (auto good = check_name("device", device.name(), no_others); !good) return good;
  if (device.streams().empty()) return fail("the device has no stream");
  std::set<std::string> streams;
  for (const v1::RecordedStream& stream : device.streams()) {
    if (auto good = check_name("stream", stream.name(), streams); !good) return good;
    const auto in_stream = [&](const std::string& what) {
      return fail(fmt::format("stream {}: {}", stream.name(), what));
    };
    if (!std::isfinite(stream.rate_hz()) || stream.rate_hz() <= 0.0) {
      return in_stream(fmt::format("rate_hz {} is not a sampling rate", stream.rate_hz()));
    }
    if (stream.counter_modulus() > kLargestModulus) {
      return in_stream(
          fmt::format("counter_modulus {} is more than 63 bits", stream.counter_modulus()));
    }
    if (stream.channels().empty()) return in_stream("it has no channel");
    std::set<std::string> channels(kOwnColumns.begin(), kOwnColumns.end());
    for (const v1::RecordedChannel& channel : stream.channels()) {
      if (auto good = check_name("channel", channel.name(), channels); !good) {
        return in_stream(good.error().message);
      }
      if (auto good = check_channel(channel); !good) return in_stream(good.error().message);
    }
  }
  return {};
}

Result<void> check_block(const v1::RecordedDevice& device, const Block& block) {
  if (block.stream >= static_cast<std::size_t>(device.streams_size())) {
    return fail(fmt::format("stream {} of {} does not exist", block.stream, device.streams_size()));
  }
  const v1::RecordedStream& stream = device.streams(static_cast<int>(block.stream));
  const auto trouble = [&](const std::string& what) {
    return fail(fmt::format("stream {}: {}", stream.name(), what));
  };
  const Rows& rows = block.rows;
  const bool counts = stream.counter_modulus() != 0;
  if (rows.flags.size() != rows.size() || rows.counter.size() != (counts ? rows.size() : 0)) {
    return trouble("host_time, counter and flags differ in length");
  }
  if (rows.channels.size() != static_cast<std::size_t>(stream.channels_size())) {
    return trouble(fmt::format("{} columns where {} channels are described", rows.channels.size(),
                               stream.channels_size()));
  }
  for (std::size_t i = 0; i < rows.channels.size(); ++i) {
    const v1::RecordedChannel& channel = stream.channels(static_cast<int>(i));
    if (rows.channels[i].index() != numbers_of_type(channel.dtype())->index() ||
        size(rows.channels[i]) != rows.size()) {
      return trouble(fmt::format("channel {}: must be {} numbers of {}", channel.name(),
                                 rows.size(), channel.dtype()));
    }
  }
  for (const Refusal& one : rows.refused) {
    const auto named = [&](const v1::RecordedChannel& c) { return c.name() == one.channel; };
    if (!one.channel.empty() &&
        std::none_of(stream.channels().begin(), stream.channels().end(), named)) {
      return trouble(
          fmt::format("a rejection names channel '{}', which does not exist", one.channel));
    }
  }
  const std::uint64_t refused = refused_rows(rows.refused);
  if (rows.received != rows.size() + refused) {
    return trouble(fmt::format("{} rows received are not {} stored and {} refused", rows.received,
                               rows.size(), refused));
  }
  return {};
}

v1::RefusalCount to_message(const Refusal& refusal) {
  v1::RefusalCount out;
  out.set_reason(std::string(word(refusal.reason)));
  out.set_channel(refusal.channel);
  out.set_samples(refusal.rows);
  return out;
}

Result<Refusal> from_message(const v1::RefusalCount& count) {
  const auto reason = refused_from_word(count.reason());
  if (!reason) return fail(fmt::format("'{}' is not a reason to reject a sample", count.reason()));
  return Refusal{*reason, count.channel(), count.samples()};
}

}  // namespace imunoise::recording
