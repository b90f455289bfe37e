#pragma once

// Structures that MTData2 and legacy MTData share.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "drivers/codec/bytes.h"
#include "drivers/codec/refusal.h"
#include "drivers/codec/sample.h"

namespace imunoise::drivers {

/// UTC as the device's GNSS receiver knows it; 12 bytes.
struct XsensUtc {
  std::uint32_t nanosecond = 0;
  std::uint16_t year = 0;
  std::uint8_t month = 0;
  std::uint8_t day = 0;
  std::uint8_t hour = 0;
  std::uint8_t minute = 0;
  std::uint8_t second = 0;
  std::uint8_t flags = 0;
  friend bool operator==(const XsensUtc&, const XsensUtc&) = default;
};

XsensUtc take_utc(BigEndianReader& in);
void append_utc(std::vector<std::uint8_t>& out, const XsensUtc& utc);
/// Seconds since 1970-01-01; nothing if there is no such instant (month 0: no receiver yet).
std::optional<double> unix_seconds(const XsensUtc& utc);
/// Appends channel "utc" in s, or refuses it as out of range.
void append_utc_value(DecodedSample& sample, const XsensUtc& utc, Refusals& refused);

/// The set bits of a status word (bit 0 self-test passed, 1 filter valid, 2 GNSS fix, 8 to 16 the
/// clipped channels, 19 any clipped, 21 SyncIn) as words. A status byte is its lowest eight bits.
void append_status_flags(std::uint32_t status, std::vector<std::string_view>& flags);

}  // namespace imunoise::drivers
