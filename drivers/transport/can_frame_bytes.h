#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/can/codec/frame.h"
#include "drivers/codec/bytes.h"

namespace imunoise::transport {

/// A frame as CAN sockets carry it: struct can_frame (16 bytes) or struct canfd_frame (72).
struct CanFrameBytes {
  std::array<std::uint8_t, 72> bytes{};
  std::size_t count = 0;

  drivers::Bytes used() const { return drivers::Bytes(bytes).first(count); }
};

CanFrameBytes bytes_of(const drivers::CanFrame& frame);
/// Nothing if these are no such struct.
std::optional<drivers::CanFrame> frame_of(drivers::Bytes bytes);

}  // namespace imunoise::transport
