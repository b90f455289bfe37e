#pragma once

// What the messages of a CAN bus mean.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/support/result.h"
#include "drivers/can/codec/frame.h"
#include "drivers/can/codec/signal.h"
#include "drivers/codec/refusal.h"

namespace imunoise::drivers {

struct CanMessage {
  std::uint32_t id = 0;
  bool extended = false;
  std::string name;
  std::size_t length = 0;  ///< bytes
  std::vector<CanSignal> signals;
};

/// One signal of a frame.
struct SignalValue {
  const CanSignal* signal = nullptr;
  std::uint64_t bits = 0;
  double physical = 0.0;
};

/// The signals that a frame with this data holds: those that are not switched, and those that their
/// multiplexors switch on. Signals that lie beyond the data's end are refused (kLength). `out` is
/// overwritten.
void decode_signals(const CanMessage& message, Bytes data, std::vector<SignalValue>& out,
                    Refusals& refused);

/// A frame with these signals, all others zero. Error: a name that the message lacks, a value that
/// does not fit, a message that is longer than a frame.
Result<CanFrame> encode_signals(
    const CanMessage& message,
    std::span<const std::pair<std::string_view, double>> physical_values);

/// Messages by identifier. Immutable once made, so it may be read from many threads.
class CanDatabase {
 public:
  CanDatabase() = default;
  /// Precondition: no two messages of one identifier.
  explicit CanDatabase(std::vector<CanMessage> messages);

  const std::vector<CanMessage>& messages() const { return messages_; }
  const CanMessage* find(std::uint32_t id, bool extended) const;
  const CanMessage* find(std::string_view name) const;

 private:
  std::vector<CanMessage> messages_;
  std::map<std::pair<bool, std::uint32_t>, std::size_t> by_id_;
};

}  // namespace imunoise::drivers
