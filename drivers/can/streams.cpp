#include "drivers/can/streams.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>

namespace imunoise::can {
namespace {

using drivers::CanMessage;
using drivers::CanSignal;
using drivers::SignalType;
using drivers::SignalValue;

constexpr std::string_view kCounter = "counter";

drivers::NumberType stored_type(const CanSignal& signal) {
  switch (signal.type) {
    case SignalType::kFloat32:
      return drivers::NumberType::kFloat32;
    case SignalType::kFloat64:
      return drivers::NumberType::kFloat64;
    default:
      break;
  }
  const std::size_t bits = signal.field.length + (signal.type == SignalType::kUnsigned ? 1 : 0);
  if (bits <= 16) return drivers::NumberType::kInt16;
  return bits <= 32 ? drivers::NumberType::kInt32 : drivers::NumberType::kInt64;
}

void set_number(plugin::Row& row, std::size_t column, const SignalValue& value) {
  switch (value.signal->type) {
    case SignalType::kUnsigned:
      row.set(column, value.bits);
      break;
    case SignalType::kSigned:
      row.set(column, drivers::sign_extended(value.bits, value.signal->field.length));
      break;
    case SignalType::kFloat32:
      row.set(column, std::bit_cast<float>(static_cast<std::uint32_t>(value.bits)));
      break;
    case SignalType::kFloat64:
      row.set(column, std::bit_cast<double>(value.bits));
      break;
  }
}

std::uint64_t all_ones(std::size_t bits) { return ~std::uint64_t{0} >> (64 - bits); }

bool same_ranges(const std::vector<drivers::MultiplexRange>& a,
                 const std::vector<drivers::MultiplexRange>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.first == y.first && x.last == y.last;
  });
}

}  // namespace

CanStream::CanStream(const CanMessage& message, const CanSignal& first) : message_(&message) {
  description_.name = message.name;
  if (!first.present_at.empty()) {
    description_.name += fmt::format("_m{}", first.present_at.front().first);
  }
}

Result<std::vector<CanStream>> CanStream::all_of(const drivers::CanChannels& channels) {
  std::vector<CanStream> out;
  for (const CanMessage& message : channels.database().messages()) {
    const auto& mapped = channels.channels_of(message);
    const std::size_t first_of_message = out.size();
    for (std::size_t i = 0; i < message.signals.size(); ++i) {
      if (!mapped[i]) continue;
      const CanSignal& signal = message.signals[i];
      auto stream = std::find_if(out.begin() + static_cast<std::ptrdiff_t>(first_of_message),
                                 out.end(), [&](const auto& s) { return s.comes_with(signal); });
      if (stream == out.end()) stream = out.insert(out.end(), CanStream(message, signal));
      if (auto added = stream->add_channel(signal, mapped[i]->mapping); !added) {
        return tl::make_unexpected(added.error());
      }
    }
  }
  return out;
}

bool CanStream::comes_with(const CanSignal& signal) const {
  const CanSignal& mine = *columns_.front().signal;
  return mine.switched_by == signal.switched_by && same_ranges(mine.present_at, signal.present_at);
}

Result<void> CanStream::add_channel(const CanSignal& signal,
                                    const drivers::ChannelMapping& mapping) {
  if (mapping.channel == kCounter) {
    if (signal.type != SignalType::kUnsigned || signal.factor != 1.0 || signal.offset != 0.0) {
      return fail(
          fmt::format("channel counter: signal {} of message {} is not an unsigned whole "
                      "number; give it another name",
                      signal.name, message_->name));
    }
    counter_column_ = columns_.size();
    description_.counter_maximum = mapping.last.value_or(all_ones(signal.field.length));
  }
  columns_.push_back({&signal, mapping.invalid_from});
  description_.channels.push_back({mapping.channel, mapping.unit.empty() ? "1" : mapping.unit,
                                   stored_type(signal), signal.factor, signal.offset});
  return {};
}

std::size_t CanStream::count(std::span<const SignalValue> present) const {
  return static_cast<std::size_t>(
      std::count_if(columns_.begin(), columns_.end(), [&](const Column& column) {
        return std::any_of(present.begin(), present.end(),
                           [&](const SignalValue& value) { return value.signal == column.signal; });
      }));
}

bool CanStream::is_in(std::span<const SignalValue> present) const {
  return !columns_.front().signal->switched_by || count(present) > 0;
}

std::uint32_t CanStream::follow(std::uint64_t counter) {
  const auto last = std::exchange(last_counter_, counter);
  const bool follows = !last || counter == (*last == description_.counter_maximum ? 0 : *last + 1);
  return follows ? 0U : std::uint32_t{IMUNOISE_SAMPLE_AFTER_GAP};
}

void CanStream::add(std::span<const SignalValue> present, std::size_t stream, std::int64_t time_ns,
                    std::uint32_t flags, plugin::Samples& samples) {
  if (count(present) < columns_.size()) {
    return samples.refuse(stream, plugin::Reason::kMalformed);
  }
  const auto value_of = [&](const Column& column) {
    return *std::find_if(present.begin(), present.end(),
                         [&](const SignalValue& value) { return value.signal == column.signal; });
  };
  plugin::Stamp stamp = {time_ns, 0, 0, flags};
  if (counter_column_) {
    stamp.counter = value_of(columns_[*counter_column_]).bits;
    if (stamp.counter > description_.counter_maximum) {
      return samples.refuse(stream, plugin::Reason::kOutOfRange);
    }
    stamp.flags |= follow(stamp.counter);
  }
  plugin::Row row = samples.add(stream, stamp);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const SignalValue value = value_of(columns_[c]);
    set_number(row, c, value);
    if (columns_[c].invalid_from && value.bits >= *columns_[c].invalid_from) {
      row.refuse(c, plugin::Reason::kFault);
    }
  }
}

}  // namespace imunoise::can
