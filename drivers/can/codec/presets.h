#pragma once

// CAN IMUs whose messages are known: a database and the channels in it. The documents leave some
// points open, which a mapping of one's own can settle; each preset names them.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "drivers/can/codec/channels.h"

namespace imunoise::drivers {

struct CanPreset {
  std::string dbc;
  std::vector<ChannelMapping> mapping;
};

/// Xsens MTi-600 with its default identifiers. Sources: McGill's notes on MT1604P; scales of rate
/// and acceleration in two more. Open: the unit of the sample time ("ticks"); the identifiers of
/// the high-rate messages, which are left out, as are delta v and pressure.
CanPreset mti600_preset();

/// ACEINNA's J1939 units at one source address: slope, rate, acceleration. Sources: Aceinna's
/// documents; a real log agrees. Open: the order of axes; here as the documents say, X, Y, Z.
CanPreset aceinna_preset(std::uint8_t source_address);
inline constexpr std::uint8_t kAceinnaAddress = 0x80;  ///< From the factory.

/// Bosch MM5.10: yaw and roll rate, three accelerations. Sources: rusEFI's identifiers, Bosch's
/// ABS-M5 manual for the scales.
CanPreset mm510_preset();

/// Names for people to choose from: "mti600", "aceinna", "mm5.10".
std::vector<std::string_view> preset_names();
/// The preset of that name, ready to decode; the address is J1939's, where the preset has one.
/// Error: no such name, with the known ones.
Result<CanChannels> make_preset(std::string_view name,
                                std::uint8_t source_address = kAceinnaAddress);

}  // namespace imunoise::drivers
