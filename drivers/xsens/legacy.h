#pragma once

// Legacy MTData: bytes without a description; which quantities they are follows from output mode
// and settings, which the Configuration message tells. Sources: paparazzi's xsens_MTi-G.xml,
// ethzasl_xsens_driver, Xsens MT0100P.N, which agree; 16.32 numbers only in the second.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/support/result.h"
#include "drivers/codec/bytes.h"
#include "drivers/codec/refusal.h"
#include "drivers/codec/sample.h"
#include "drivers/xsens/fields.h"

namespace imunoise::drivers {

/// What an MTData message holds.
struct LegacyLayout {
  std::uint16_t mode = 0;      ///< OutputMode: which groups.
  std::uint32_t settings = 0;  ///< OutputSettings: how they are written, what is left out.
  friend bool operator==(const LegacyLayout&, const LegacyLayout&) = default;
};

/// Answer to ReqConfiguration; 118 bytes.
struct XsensConfiguration {
  std::uint32_t device_id = 0;
  std::uint16_t period = 0;  ///< Ticks of 1/115200 s.
  std::uint16_t skip_factor = 0;
  LegacyLayout layout;
  friend bool operator==(const XsensConfiguration&, const XsensConfiguration&) = default;
};

/// Error: any other length than 118 bytes.
Result<XsensConfiguration> decode_configuration(Bytes payload);
/// Payload of a Configuration message; fields that nobody reads are zero.
std::vector<std::uint8_t> encode_configuration(const XsensConfiguration& configuration);

/// What one MTData message says.
struct LegacyData {
  std::optional<std::uint16_t> counter;
  DecodedSample sample;  ///< stream "imu", values and flags; no time, no counter.
};

/// Reads `payload`; `out` is overwritten. False, and refused for its length, when the payload is
/// not exactly as long as the layout says.
bool decode_legacy(Bytes payload, LegacyLayout layout, LegacyData& out, Refusals& refused);

/// Composes the payload of an MTData message. `numbers` are the values in the order in which
/// decode_legacy() gives them, in the units of the device (m/s², rad/s, °C, °). Precondition: as
/// many as the layout has.
std::vector<std::uint8_t> encode_legacy(LegacyLayout layout, std::span<const double> numbers,
                                        std::uint8_t status, std::uint16_t counter,
                                        const XsensUtc& utc);

}  // namespace imunoise::drivers
