#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/xsens/codec/legacy.h"
#include "drivers/xsens/codec/number.h"

namespace imunoise::xsens {

enum class Protocol : std::uint8_t {
  kAuto,     ///< MTData2 where the device knows it.
  kMtData2,  ///< Fourth generation: MTi-G-710.
  kLegacy,   ///< MTData: MTi-G.
};

/// What the user chose.
struct Settings {
  std::string port;
  std::optional<std::uint32_t> baud;  ///< The device is set to it; absent: as it is found.
  Protocol protocol = Protocol::kAuto;
  std::uint16_t rate_hz = 100;
  drivers::XsensFormat format = drivers::XsensFormat::kFloat32;
  drivers::LegacyCalibrated outputs;
};

}  // namespace imunoise::xsens
