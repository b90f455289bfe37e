#include "drivers/can/codec/database.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace imunoise::drivers {
namespace {

// Whether the signal is in a frame with this data. Multiplexors may be switched themselves; the
// parser has seen to it that the chain ends.
bool is_present(const CanMessage& message, const CanSignal& signal, Bytes data) {
  if (!signal.switched_by) return true;
  const CanSignal& multiplexor = message.signals[*signal.switched_by];
  if (bytes_needed(multiplexor.field) > data.size()) return false;
  if (!is_present(message, multiplexor, data)) return false;
  const std::uint64_t selected = extract_bits(data, multiplexor.field);
  return std::any_of(signal.present_at.begin(), signal.present_at.end(),
                     [&](const MultiplexRange& range) {
                       return range.first <= selected && selected <= range.last;
                     });
}

}  // namespace

void decode_signals(const CanMessage& message, Bytes data, std::vector<SignalValue>& out,
                    Refusals& refused) {
  out.clear();
  for (const CanSignal& signal : message.signals) {
    if (!is_present(message, signal, data)) continue;
    if (bytes_needed(signal.field) > data.size()) {
      refused.add(Refusal::kLength);
      continue;
    }
    const std::uint64_t bits = extract_bits(data, signal.field);
    out.push_back({&signal, bits, physical_value(signal, bits)});
  }
}

Result<CanFrame> encode_signals(
    const CanMessage& message,
    std::span<const std::pair<std::string_view, double>> physical_values) {
  CanFrame out;
  if (message.length > out.bytes.size()) {
    return fail(fmt::format("message {}: {} bytes do not fit into one frame", message.name,
                            message.length));
  }
  out.id = message.id;
  out.extended = message.extended;
  out.fd = message.length > 8;
  out.length = static_cast<std::uint8_t>(message.length);
  for (const auto& [name, physical] : physical_values) {
    const auto signal =
        std::find_if(message.signals.begin(), message.signals.end(),
                     [&, wanted = name](const CanSignal& known) { return known.name == wanted; });
    if (signal == message.signals.end()) {
      return fail(fmt::format("message {}: has no signal {}", message.name, name));
    }
    const Result<std::uint64_t> bits = bits_for(*signal, physical);
    if (!bits) return tl::unexpected(bits.error());
    insert_bits(out.bytes, signal->field, *bits);
  }
  return out;
}

CanDatabase::CanDatabase(std::vector<CanMessage> messages) : messages_(std::move(messages)) {
  for (std::size_t i = 0; i < messages_.size(); ++i) {
    [[maybe_unused]] const auto added =
        by_id_.emplace(std::pair(messages_[i].extended, messages_[i].id), i);
    assert(added.second);
  }
}

const CanMessage* CanDatabase::find(std::uint32_t id, bool extended) const {
  const auto found = by_id_.find({extended, id});
  return found == by_id_.end() ? nullptr : &messages_[found->second];
}

const CanMessage* CanDatabase::find(std::string_view name) const {
  const auto found = std::find_if(messages_.begin(), messages_.end(),
                                  [&](const CanMessage& message) { return message.name == name; });
  return found == messages_.end() ? nullptr : &*found;
}

}  // namespace imunoise::drivers
