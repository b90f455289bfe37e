#pragma once

// The stream model: what a device delivers while it is recorded. A device has streams; a stream has
// channels that share one clock, one counter and one time column. Descriptions are the messages of
// proto/imunoise/v1/recording.proto, numbers keep the device's type.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/support/result.h"
#include "imunoise/v1/recording.pb.h"

namespace imunoise::recording {

/// The numbers of one channel, in the device's own type.
using Numbers = std::variant<std::vector<std::int16_t>, std::vector<std::int32_t>,
                             std::vector<std::int64_t>, std::vector<float>, std::vector<double>>;

/// Empty numbers of the type that a RecordedChannel's dtype names; nothing for an unknown one.
std::optional<Numbers> numbers_of_type(std::string_view dtype);
/// How many there are.
std::size_t size(const Numbers& numbers);
/// Appends numbers of the same type. Precondition: the types agree.
void append(Numbers& to, const Numbers& from);

/// Bits of a row's flags. The lower 16 are the driver's own.
enum RowFlag : std::uint32_t {
  /// Samples are missing between the row before and this one: refused, lost or never written.
  kLostBefore = 1U << 31U,
};

/// Why a sample that the device delivered is not stored.
enum class Refused {
  kChecksum,    ///< The transfer was damaged.
  kStale,       ///< The device had not made a new sample yet.
  kOutOfRange,  ///< A value that the device cannot measure.
  kMalformed,   ///< Not what the protocol allows.
  kInvalid,     ///< The device itself marks it as invalid.
  kOverrun,     ///< It came faster than it could be written.
  kNotWritten,  ///< The disk took it no longer.
};
/// "checksum", "stale", "out_of_range", "malformed", "invalid", "overrun", "not_written".
std::string_view word(Refused reason);
std::optional<Refused> refused_from_word(std::string_view word);

/// How many rows were refused for one reason; each refused row is counted once.
struct Refusal {
  Refused reason = Refused::kChecksum;
  std::string channel;  ///< The one to blame; empty: the row as a whole.
  std::uint64_t rows = 0;
  friend bool operator==(const Refusal&, const Refusal&) = default;
};

/// Adds counts of the same reason and channel up.
void add_refusals(std::vector<Refusal>& to, const std::vector<Refusal>& from);
std::uint64_t refused_rows(const std::vector<Refusal>& refusals);

/// Rows of one stream: columns of equal length n. The code that rejects or loses rows sets
/// kLostBefore on the row that follows them.
struct Rows {
  std::vector<std::int64_t> host_time;  ///< (n) ns since 1970-01-01 UTC.
  std::vector<std::int64_t> counter;    ///< (n), or empty when the device has none.
  std::vector<std::uint32_t> flags;     ///< (n) RowFlag.
  std::vector<Numbers> channels;        ///< (channels) of (n).
  std::uint64_t received = 0;           ///< n + refused rows: what the device delivered.
  std::vector<Refusal> refused;

  std::size_t size() const { return host_time.size(); }
};

/// What every stream has besides its channels, which may not have these names.
inline constexpr std::array<std::string_view, 3> kOwnColumns = {"host_time", "counter", "flags"};

/// No rows, with the columns that the stream's description asks for.
/// Precondition: check_device() accepted the description.
Rows empty_rows(const v1::RecordedStream& stream);
/// Appends rows of the same stream, with their counts.
void append(Rows& to, const Rows& from);

/// Consecutive rows of one stream, as a driver hands them over.
struct Block {
  std::size_t stream = 0;  ///< Index in RecordedDevice.streams.
  Rows rows;
};

/// Error: a name that no file or HDF5 group can have, two of one name, an unknown dtype, a rate or
/// scale that is not usable, no stream, no channel. Without the device's name or place.
Result<void> check_device(const v1::RecordedDevice& device);
/// Error: columns that do not fit the description or one another, counts that do not add up
/// (received = stored + refused), a refusal that blames a channel which the stream has not.
Result<void> check_block(const v1::RecordedDevice& device, const Block& block);

/// Conversion at the edge of files.
v1::RefusalCount to_message(const Refusal& refusal);
/// Error: a reason that is no word of Refused.
Result<Refusal> from_message(const v1::RefusalCount& count);

}  // namespace imunoise::recording
