#pragma once

// Numbers of any width and byte order, as doubles.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace imunoise::recording {

struct NumberLayout {
  enum class Kind { kSigned, kUnsigned, kFloat };
  Kind kind = Kind::kFloat;
  std::size_t width = 8;  ///< bytes: 1, 2, 4 or 8; of floats 4 or 8
  bool swap = false;      ///< big-endian
};

template <class Number>
Number plain_number(const char* from, bool swap) {
  std::array<char, sizeof(Number)> raw;
  std::memcpy(raw.data(), from, raw.size());
  if (swap) std::reverse(raw.begin(), raw.end());
  Number out;
  std::memcpy(&out, raw.data(), raw.size());
  return out;
}

/// Integers beyond 2^53 are rounded. Precondition: a width that the kind has.
inline double number_at(const char* from, const NumberLayout& layout) {
  const bool swap = layout.swap;
  switch (layout.kind) {
    case NumberLayout::Kind::kFloat:
      return layout.width == 4 ? static_cast<double>(plain_number<float>(from, swap))
                               : plain_number<double>(from, swap);
    case NumberLayout::Kind::kSigned:
      switch (layout.width) {
        case 1:
          return plain_number<std::int8_t>(from, swap);
        case 2:
          return plain_number<std::int16_t>(from, swap);
        case 4:
          return plain_number<std::int32_t>(from, swap);
        default:
          return static_cast<double>(plain_number<std::int64_t>(from, swap));
      }
    case NumberLayout::Kind::kUnsigned:
      break;
  }
  switch (layout.width) {
    case 1:
      return plain_number<std::uint8_t>(from, swap);
    case 2:
      return plain_number<std::uint16_t>(from, swap);
    case 4:
      return plain_number<std::uint32_t>(from, swap);
    default:
      return static_cast<double>(plain_number<std::uint64_t>(from, swap));
  }
}

}  // namespace imunoise::recording
