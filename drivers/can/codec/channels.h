#pragma once

// Which signals of a bus are which channels of a sensor.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "drivers/can/codec/database.h"
#include "drivers/codec/sample.h"
#include "drivers/codec/si_unit.h"

namespace imunoise::drivers {

/// One line of a configuration: this signal is that channel.
struct ChannelMapping {
  std::string message;
  std::string signal;
  std::string channel;  ///< e.g. "gyro_x"
  std::string unit;     ///< Of the physical value; empty: as the database says.
  /// Bits from this value on mean "not valid" (J1939's upper codes).
  std::optional<std::uint64_t> invalid_from;
  /// Of a counter: the value after which it is 0 again; unset: all its bits are ones.
  std::optional<std::uint64_t> last = {};
};

/// A database and the channels made of it. Samples borrow names and units from it. Immutable once
/// made, so it may be read from many threads.
class CanChannels {
 public:
  /// An empty mapping makes a channel of every signal, under its own name. Error: a message or
  /// signal that the database lacks, one signal mapped twice.
  static Result<CanChannels> make(CanDatabase database, std::span<const ChannelMapping> mapping);

  enum class Outcome : std::uint8_t {
    kSample,   ///< `sample` holds stream (the message's name) and values.
    kIgnored,  ///< The message is known, and none of its signals is a channel.
    kRefused,  ///< An error frame, a remote frame, an unknown message.
  };
  /// What a frame says. `sample` is overwritten; time and source are the caller's.
  Outcome decode(const CanFrame& frame, DecodedSample& sample, Refusals& refused) const;

  const CanDatabase& database() const { return database_; }

  /// What a signal was mapped to.
  struct Channel {
    ChannelMapping mapping;  ///< Its unit: as the database says where the user said nothing.
    SiUnit unit;
  };
  /// As the message's signals; nothing where a signal is no channel. Precondition: a message of the
  /// database.
  const std::vector<std::optional<Channel>>& channels_of(const CanMessage& message) const {
    return messages_[static_cast<std::size_t>(&message - database_.messages().data())].channels;
  }

 private:
  struct Message {
    bool used = false;
    std::vector<std::optional<Channel>> channels;
  };

  explicit CanChannels(CanDatabase database) : database_(std::move(database)) {}

  CanDatabase database_;
  std::vector<Message> messages_;  // as the database's
};

}  // namespace imunoise::drivers
