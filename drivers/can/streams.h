#pragma once

// From CAN frames to rows: which signals make a stream, and how they are stored.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/support/result.h"
#include "drivers/can/codec/channels.h"
#include "drivers/description.h"
#include "drivers/plugin/samples.h"

namespace imunoise::can {

/// The channels of one message that come in the same frames: those that are always present, or
/// those that one value of a multiplexor switches on.
class CanStream {
 public:
  /// Every stream of these channels, in the order of the database. Borrows them. Error: a counter
  /// that is no unsigned whole number.
  static Result<std::vector<CanStream>> all_of(const drivers::CanChannels& channels);

  const drivers::CanMessage& message() const { return *message_; }
  /// Numbers stay as the bus carries them, with the database's factor and offset as their scale. A
  /// channel named "counter" is the stream's counter as well. The rate is not known.
  const drivers::Stream& description() const { return description_; }

  /// Whether these signals of a frame of the message are, or should be, a sample of this stream.
  bool is_in(std::span<const drivers::SignalValue> present) const;
  /// Adds the sample, or counts why there is none. `stream` is this one's number, `flags` are those
  /// that the caller knows of.
  void add(std::span<const drivers::SignalValue> present, std::size_t stream, std::int64_t time_ns,
           std::uint32_t flags, plugin::Samples& samples);

  void set_rate(double rate_hz) { description_.nominal_rate_hz = rate_hz; }
  /// The next counter does not follow the last.
  void forget_counter() { last_counter_.reset(); }

 private:
  struct Column {
    const drivers::CanSignal* signal;
    std::optional<std::uint64_t> invalid_from;
  };

  CanStream(const drivers::CanMessage& message, const drivers::CanSignal& first);
  Result<void> add_channel(const drivers::CanSignal& signal,
                           const drivers::ChannelMapping& mapping);
  bool comes_with(const drivers::CanSignal& signal) const;
  std::size_t count(std::span<const drivers::SignalValue> present) const;
  std::uint32_t follow(std::uint64_t counter);

  const drivers::CanMessage* message_;
  std::vector<Column> columns_;
  drivers::Stream description_;
  std::optional<std::size_t> counter_column_;
  std::optional<std::uint64_t> last_counter_;
};

}  // namespace imunoise::can
