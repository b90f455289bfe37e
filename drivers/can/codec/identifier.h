#pragma once

// The bits of CAN identifiers.

#include <cstdint>

namespace imunoise::drivers {

inline constexpr std::uint32_t kStandardMask = 0x7ff;
inline constexpr std::uint32_t kExtendedMask = 0x1fff'ffff;
/// How DBC files say that an identifier has 29 bits.
inline constexpr std::uint32_t kDbcExtendedFlag = 0x8000'0000;

}  // namespace imunoise::drivers
