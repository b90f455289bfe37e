#pragma once

// The one list of the formats in which a device's bytes are captured. `imunoise decode`, `imunoise
// replay` and the driver "wire" all take it from here.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace imunoise::drivers {

enum class WireFormat : std::uint8_t {
  kXbus,       ///< Bytes of an Xsens device's serial line.
  kCandump,    ///< Text of candump -L.
  kAdis16405,  ///< Bursts of 26 bytes of an ADIS16405.
};

inline constexpr std::array kWireFormats = {WireFormat::kXbus, WireFormat::kCandump,
                                            WireFormat::kAdis16405};

/// As users write it: "xbus", "candump", "adis16405".
std::string_view name_of(WireFormat format);
/// All of them, in the order of kWireFormats.
std::vector<std::string> wire_format_names();
/// Nothing: there is no such format.
std::optional<WireFormat> find_wire_format(std::string_view name);

}  // namespace imunoise::drivers
