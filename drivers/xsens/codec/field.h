#pragma once

// Fields of fixed structures: one table serves decoding and encoding.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "drivers/codec/bytes.h"

namespace imunoise::drivers {

/// One number of a structure, in the order of the wire. Without a channel it is skipped.
struct XsensField {
  enum class Kind : std::uint8_t {
    kU8,
    kU16,
    kU32,
    kI32,
    kNumber,  ///< In one of the four formats, which stands elsewhere.
  };
  Kind kind = Kind::kNumber;
  std::string_view channel;
  std::string_view unit;
  double scale = 1.0;  ///< value = number on the wire · scale
};

/// Bytes of a whole number. Precondition: not kNumber.
constexpr std::size_t bytes_of(XsensField::Kind kind) {
  switch (kind) {
    case XsensField::Kind::kU8:
      return 1;
    case XsensField::Kind::kU16:
      return 2;
    default:
      return 4;
  }
}

/// The next whole number of `in`. Precondition: not kNumber.
inline double take_whole(BigEndianReader& in, XsensField::Kind kind) {
  switch (kind) {
    case XsensField::Kind::kU8:
      return in.take<std::uint8_t>();
    case XsensField::Kind::kU16:
      return in.take<std::uint16_t>();
    case XsensField::Kind::kU32:
      return in.take<std::uint32_t>();
    default:
      return in.take<std::int32_t>();
  }
}

}  // namespace imunoise::drivers
