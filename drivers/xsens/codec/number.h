#pragma once

// The four number formats of Xsens outputs. Source: Xsens MT0101P 2020.A, section "MTData2"; all
// four agree with captures of real devices.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/codec/bytes.h"

namespace imunoise::drivers {

/// As the two lowest bits of a data identifier say.
enum class XsensFormat : std::uint8_t {
  kFloat32 = 0,
  kFixed12_20 = 1,  ///< 32-bit integer, 20 bits of it fraction
  kFixed16_32 = 2,  ///< 32-bit fraction, then signed 16-bit integer
  kFloat64 = 3,
};

/// Bytes of one number: 4, 4, 6, 8.
std::size_t size_of(XsensFormat format);

/// The next number of `in`; zero when too few bytes are left (in.ok() tells).
double take_number(BigEndianReader& in, XsensFormat format);

/// Appends `value`, rounded to the format; fixed point formats saturate. Precondition: not NaN for
/// fixed point.
void append_number(std::vector<std::uint8_t>& out, XsensFormat format, double value);

}  // namespace imunoise::drivers
