#pragma once

// Why something that came over the wire did not become a sample. Every codec counts by these.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace imunoise::drivers {

enum class Refusal : std::uint8_t {
  kOutsideMessages,  ///< Bytes between messages; counted in bytes.
  kChecksum,         ///< Messages whose checksum does not fit.
  kLength,           ///< Messages, items or signals of an impossible length.
  kTruncated,        ///< Messages cut off by the end of the data.
  kUnknownItem,      ///< Items of a message with an unknown identifier, skipped by their length.
  kUnknownMessage,   ///< CAN frames that no database entry describes.
  kNoLayout,         ///< Legacy MTData before a Configuration message has said its layout.
  kDeviceError,      ///< Error messages of the device.
  kNotFinite,        ///< Values that are no number (NaN, infinity).
  kOutOfRange,       ///< Values that the device marks as invalid, or that cannot be (month 13).
  kStale,            ///< Bursts that were read before, or in which nothing is new.
  kTorn,             ///< Bursts in which some inertial words are new and others are not.
  kNoAnswer,         ///< Bursts of ones: nothing drives the line.
  kMalformedLine,    ///< Lines of text that are no CAN frame.
  kErrorFrame,       ///< CAN error frames.
  kRemoteFrame,      ///< CAN remote frames: a question, no data.
};

inline constexpr std::size_t kRefusals = 16;

/// One word for machines, e.g. "checksum".
std::string_view name_of(Refusal refusal);
/// One sentence for people: what was refused, and what it hints at.
std::string_view meaning_of(Refusal refusal);

/// Counts by reason.
class Refusals {
 public:
  void add(Refusal reason, std::uint64_t count = 1) {
    counts_[static_cast<std::size_t>(reason)] += count;
  }
  std::uint64_t count(Refusal reason) const { return counts_[static_cast<std::size_t>(reason)]; }
  /// Whether nothing was refused.
  bool none() const { return *this == Refusals{}; }

  Refusals& operator+=(const Refusals& other) {
    for (std::size_t i = 0; i < kRefusals; ++i) counts_[i] += other.counts_[i];
    return *this;
  }
  friend bool operator==(const Refusals&, const Refusals&) = default;

 private:
  std::array<std::uint64_t, kRefusals> counts_{};
};

}  // namespace imunoise::drivers
