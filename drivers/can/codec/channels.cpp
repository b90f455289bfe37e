#include "drivers/can/codec/channels.h"

#include <fmt/format.h>

#include <algorithm>

namespace imunoise::drivers {

Result<CanChannels> CanChannels::make(CanDatabase database,
                                      std::span<const ChannelMapping> mapping) {
  CanChannels out(std::move(database));
  const std::vector<CanMessage>& known = out.database_.messages();
  for (const CanMessage& message : known) {
    Message& entry = out.messages_.emplace_back();
    entry.channels.resize(message.signals.size());
    if (!mapping.empty()) continue;
    entry.used = true;
    for (std::size_t i = 0; i < message.signals.size(); ++i) {
      const CanSignal& signal = message.signals[i];
      entry.channels[i] =
          Channel{{message.name, signal.name, signal.name, signal.unit, {}}, si_unit(signal.unit)};
    }
  }
  for (const ChannelMapping& line : mapping) {
    const CanMessage* const message = out.database_.find(line.message);
    if (message == nullptr) {
      return fail(
          fmt::format("channel {}: the database has no message {}", line.channel, line.message));
    }
    const auto signal =
        std::find_if(message->signals.begin(), message->signals.end(),
                     [&](const CanSignal& candidate) { return candidate.name == line.signal; });
    if (signal == message->signals.end()) {
      return fail(fmt::format("channel {}: message {} has no signal {}", line.channel, line.message,
                              line.signal));
    }
    Message& entry = out.messages_[static_cast<std::size_t>(message - known.data())];
    auto& channel = entry.channels[static_cast<std::size_t>(signal - message->signals.begin())];
    if (channel) {
      return fail(fmt::format("channel {}: signal {} of message {} is channel {} already",
                              line.channel, line.signal, line.message, channel->mapping.channel));
    }
    channel = Channel{line, {}};
    if (line.unit.empty()) channel->mapping.unit = signal->unit;
    channel->unit = si_unit(channel->mapping.unit);
    entry.used = true;
  }
  return out;
}

CanChannels::Outcome CanChannels::decode(const CanFrame& frame, DecodedSample& sample,
                                         Refusals& refused) const {
  const auto refuse = [&](Refusal reason) {
    refused.add(reason);
    return Outcome::kRefused;
  };
  if (frame.error) return refuse(Refusal::kErrorFrame);
  if (frame.remote) return refuse(Refusal::kRemoteFrame);
  const CanMessage* const message = database_.find(frame.id, frame.extended);
  if (message == nullptr) return refuse(Refusal::kUnknownMessage);
  const Message& entry = messages_[static_cast<std::size_t>(message - database_.messages().data())];
  if (!entry.used) return Outcome::kIgnored;

  sample.clear();
  sample.stream = message->name;
  std::vector<SignalValue> values;
  decode_signals(*message, frame.data(), values, refused);
  for (const SignalValue& value : values) {
    const auto& channel =
        entry.channels[static_cast<std::size_t>(value.signal - message->signals.data())];
    if (!channel) continue;
    const auto& invalid_from = channel->mapping.invalid_from;
    if (invalid_from && value.bits >= *invalid_from) {
      refused.add(Refusal::kOutOfRange);
    } else {
      append_value(sample, channel->mapping.channel, channel->unit, value.physical, refused);
    }
  }
  return Outcome::kSample;
}

}  // namespace imunoise::drivers
