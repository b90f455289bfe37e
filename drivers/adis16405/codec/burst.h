#pragma once

// The burst: all outputs in one transfer of 26 bytes, the first two of which mean nothing. Bit 15
// of each word (ND) says that it is new, bit 14 (EA) that DIAG_STAT holds a flag. Source:
// ADIS16400/405 datasheet Rev. B, which later sheets of the family confirm; Linux and Satellogic
// name the two bits in other ways.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "core/support/result.h"
#include "drivers/adis16405/codec/registers.h"
#include "drivers/codec/bytes.h"
#include "drivers/codec/refusal.h"
#include "drivers/codec/si_unit.h"

namespace imunoise::drivers::adis16405 {

inline constexpr std::size_t kBurstBytes = 26;
inline constexpr std::size_t kBurstChannels = 12;

/// What the sensor is sent for a burst; the answer is as long.
inline constexpr std::array<std::uint8_t, kBurstBytes> kBurstRequest = {kBurstCommand >> 8U};

/// Names of the channels in the order of the burst: "supply", "gyro_x", ..., "aux_adc".
extern const std::array<std::string_view, kBurstChannels> kChannelNames;

/// Sets of channels: bit i is kChannelNames[i].
inline constexpr std::uint16_t kInertialChannels = 0x007e;  ///< gyro_x .. acc_z
inline constexpr std::uint16_t kMagneticChannels = 0x0380;  ///< mag_x .. mag_z
inline constexpr std::uint16_t kSlowChannels = 0x0c01;      ///< supply, temperature, aux_adc

/// Counts in the order of kChannelNames, and the bits beside them: bit i belongs to channel i.
struct Burst {
  std::array<std::int16_t, kBurstChannels> counts{};
  std::uint16_t is_new = 0;  ///< ND
  std::uint16_t alarm = 0;   ///< EA
  friend bool operator==(const Burst&, const Burst&) = default;
};

/// How the counts of a channel become a quantity: counts · scale + offset, in `unit`.
struct CountScale {
  std::string_view unit;  ///< As the datasheet writes it: V, deg/s, g, gauss, degC.
  double scale = 1.0;
  double offset = 0.0;
};

/// Scales in the order of kChannelNames. Error: SENS_AVG holds no valid range.
Result<std::array<CountScale, kBurstChannels>> count_scales(std::uint16_t sensitivity_averaging);

/// The same for quantities in SI (units that are not known to it stay as they are).
std::array<SiUnit, kBurstChannels> si_scales(const std::array<CountScale, kBurstChannels>& scales);

/// Reads the words of one burst, whether they are new or not. Refused: any other length than 26
/// bytes (kLength), a line that nothing drives (kNoAnswer).
tl::expected<Burst, Refusal> parse_burst(Bytes bytes);

/// A burst that is a sample. Refused: what parse_burst() refuses, no new gyroscope or accelerometer
/// word (kStale) or only some (kTorn). Slower channels (magnetometer, supply, temperature,
/// auxiliary) may be old: `is_new` tells.
tl::expected<Burst, Refusal> decode_burst(Bytes bytes);

/// The 26 bytes of a burst as a device sends them. Counts outside their 14 or 12 bits saturate.
std::vector<std::uint8_t> encode_burst(const Burst& burst);

}  // namespace imunoise::drivers::adis16405
