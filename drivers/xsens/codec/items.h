#pragma once

// What MTData2 items are called and hold. Source: Xsens MT0101P 2020.A, section "MTData2".

#include <cstdint>
#include <string_view>
#include <vector>

#include "drivers/codec/si_unit.h"
#include "drivers/xsens/codec/number.h"

namespace imunoise::drivers {

/// Identifiers without format and frame (the low nibble).
enum class XsensItem : std::uint16_t {
  kTemperature = 0x0810,
  kUtcTime = 0x1010,
  kPacketCounter = 0x1020,
  kSampleTimeFine = 0x1060,
  kSampleTimeCoarse = 0x1070,
  kQuaternion = 0x2010,
  kRotationMatrix = 0x2020,
  kEulerAngles = 0x2030,
  kPressure = 0x3010,
  kDeltaV = 0x4010,
  kAcceleration = 0x4020,
  kFreeAcceleration = 0x4030,
  kAccelerationHr = 0x4040,
  kAltitude = 0x5020,
  kPositionEcef = 0x5030,
  kLatLon = 0x5040,
  kGnssSolution = 0x7010,
  kGnssSatellites = 0x7020,
  kRateOfTurn = 0x8020,
  kDeltaQ = 0x8030,
  kRateOfTurnHr = 0x8040,
  kMagneticField = 0xc020,
  kVelocity = 0xd010,
  kStatusByte = 0xe010,
  kStatusWord = 0xe020,
};

/// The item that an identifier names, whatever its format and frame.
constexpr XsensItem kind_of(std::uint16_t id) { return static_cast<XsensItem>(id & 0xfff0U); }

/// The numbers that an item holds in one of the four formats.
struct XsensNumberItem {
  XsensItem item = {};
  std::string_view unit;  ///< As the device states it: "degC", "rad/s".
  std::vector<std::string_view> channels;
  bool framed = false;  ///< The identifier says in which frame: ENU, NED or NWU.
  SiUnit si = {};       ///< Of the unit.
};

/// Nothing if the item of this identifier (its low nibble is not looked at) holds no such numbers.
const XsensNumberItem* find_number_item(std::uint16_t id);
/// The format that an identifier names.
constexpr XsensFormat format_of(std::uint16_t id) { return static_cast<XsensFormat>(id & 3U); }
/// The identifier of an item of numbers in that format.
constexpr std::uint16_t id_of(XsensItem item, XsensFormat format) {
  return static_cast<std::uint16_t>(static_cast<unsigned>(item) | static_cast<unsigned>(format));
}

}  // namespace imunoise::drivers
