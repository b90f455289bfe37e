#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/codec/bytes.h"

namespace imunoise::drivers {

/// One frame of CAN or CAN FD, or what the controller reports in its place.
struct CanFrame {
  std::uint32_t id = 0;       ///< 11 or 29 bits; an error frame's class bits.
  bool extended = false;      ///< 29-bit identifier
  bool remote = false;        ///< asks for data and carries none
  bool error = false;         ///< error frame of Linux: `id` says the class
  bool fd = false;            ///< CAN FD
  std::uint8_t fd_flags = 0;  ///< as Linux: 1 bit rate switch, 2 error state of the sender
  std::uint8_t length = 0;    ///< bytes of data, at most 64; of a remote frame, those asked for
  std::array<std::uint8_t, 64> bytes{};

  Bytes data() const { return Bytes(bytes).first(remote ? 0 : length); }
  friend bool operator==(const CanFrame&, const CanFrame&) = default;
};

/// Whether CAN FD has frames of this length: 0 to 8, 12, 16, 20, 24, 32, 48, 64.
constexpr bool is_fd_length(std::size_t length) {
  return length <= 8 || (length <= 24 && length % 4 == 0) || length == 32 || length == 48 ||
         length == 64;
}

}  // namespace imunoise::drivers
