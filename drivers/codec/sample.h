#pragma once

// The one vocabulary of all codecs: a sample as it leaves the wire.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace imunoise::drivers {

/// Whose clock a time stamp is from.
enum class Clock : std::uint8_t {
  kNone,     ///< There is no time stamp.
  kDevice,   ///< The device's own, from its own zero.
  kHost,     ///< The recording computer's, since 1970-01-01 UTC.
  kNominal,  ///< Counted samples over the configured rate: not measured.
};

/// One word, e.g. "device".
std::string_view name_of(Clock clock);

/// One channel's value: in SI where core/support/units knows the unit (rad/s, m/s^2, T, K, V), else
/// in the unit that the device states.
struct DecodedValue {
  std::string_view channel;  ///< e.g. "gyro_x"
  std::string_view unit;     ///< e.g. "rad/s"
  double value = 0.0;        ///< finite
};

/// What one message says. Texts are borrowed: from the program, the CAN database, or (source) the
/// decoder until its next call.
struct DecodedSample {
  std::string_view stream;  ///< What shares one clock and counter: "imu", "gnss", a CAN message.
  std::string_view source;  ///< Interface it came in by, e.g. "can0"; else empty.
  Clock clock = Clock::kNone;
  std::int64_t time_ns = 0;             ///< Unwrapped; without meaning for Clock::kNone.
  std::optional<std::int64_t> counter;  ///< The device's own count, unwrapped.
  std::vector<DecodedValue> values;
  std::vector<std::string_view> flags;  ///< e.g. "clip_acc_x"

  /// Makes it empty and keeps its memory.
  void clear() {
    stream = source = {};
    clock = Clock::kNone;
    time_ns = 0;
    counter.reset();
    values.clear();
    flags.clear();
  }
};

}  // namespace imunoise::drivers
