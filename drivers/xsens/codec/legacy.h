#pragma once

// Legacy MTData: bytes without a description; which quantities they are follows from output mode
// and settings, which the Configuration message tells. Sources: paparazzi's xsens_MTi-G.xml,
// ethzasl_xsens_driver, Xsens MT0100P.N, which agree; 16.32 numbers only in the second.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "drivers/codec/bytes.h"
#include "drivers/codec/refusal.h"
#include "drivers/codec/sample.h"
#include "drivers/xsens/codec/fields.h"
#include "drivers/xsens/codec/number.h"

namespace imunoise::drivers {

/// What an MTData message holds.
struct LegacyLayout {
  std::uint16_t mode = 0;      ///< OutputMode: which groups.
  std::uint32_t settings = 0;  ///< OutputSettings: how they are written, what is left out.
  friend bool operator==(const LegacyLayout&, const LegacyLayout&) = default;
};

/// Calibrated acceleration, rate and field (those that are wanted), temperature, status, counter.
struct LegacyCalibrated {
  bool acceleration = true;
  bool rate = true;
  bool field = true;
  bool temperature = true;
};
LegacyLayout calibrated_layout(LegacyCalibrated wanted, XsensFormat format);

/// Answer to ReqConfiguration; 118 bytes.
struct XsensConfiguration {
  std::uint32_t device_id = 0;
  std::uint16_t period = 0;  ///< Ticks of 1/115200 s.
  std::uint16_t skip_factor = 0;
  LegacyLayout layout;
  friend bool operator==(const XsensConfiguration&, const XsensConfiguration&) = default;
};

/// Messages a second.
double rate_of(const XsensConfiguration& configuration);
/// SetPeriod's number for a rate; rounded. Precondition: at least 2 Hz.
std::uint16_t legacy_period(double rate_hz);

/// Error: any other length than 118 bytes.
Result<XsensConfiguration> decode_configuration(Bytes payload);
/// Payload of a Configuration message; unused fields are zero.
std::vector<std::uint8_t> encode_configuration(const XsensConfiguration& configuration);

/// One number of an MTData message. Texts are the program's.
struct LegacyChannel {
  std::string_view name;
  std::string_view unit;  ///< As the device states it.
};

/// What an MTData message of this layout holds before its status byte, in the order of the wire.
std::vector<LegacyChannel> channels_of(LegacyLayout layout);
/// The format of those that are not counts.
XsensFormat format_of(LegacyLayout layout);

/// What one MTData message says.
struct LegacyData {
  std::optional<std::uint16_t> counter;
  std::optional<std::uint8_t> status;
  std::vector<double> numbers;  ///< As channels_of() names them, in the device's units.
  DecodedSample sample;         ///< stream "imu", values in SI and flags; no time, no counter.
};

/// Reads `payload`; `out` is overwritten. False, and refused for its length, when the payload is
/// not exactly as long as the layout says.
bool decode_legacy(Bytes payload, LegacyLayout layout, LegacyData& out, Refusals& refused);

/// Composes the payload of an MTData message. Precondition: as many numbers as channels_of() the
/// layout.
std::vector<std::uint8_t> encode_legacy(LegacyLayout layout, std::span<const double> numbers,
                                        std::uint8_t status, std::uint16_t counter,
                                        const XsensUtc& utc);

}  // namespace imunoise::drivers
