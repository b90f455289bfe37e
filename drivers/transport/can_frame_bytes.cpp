#include "drivers/transport/can_frame_bytes.h"

#include <linux/can.h>

#include <algorithm>
#include <cstring>

namespace imunoise::transport {

CanFrameBytes bytes_of(const drivers::CanFrame& frame) {
  canfd_frame raw{};  // struct can_frame is its beginning
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) |
               (frame.remote ? CAN_RTR_FLAG : 0U) | (frame.error ? CAN_ERR_FLAG : 0U);
  raw.len = frame.length;
  raw.flags = frame.fd_flags;
  std::copy(frame.bytes.begin(), frame.bytes.end(), raw.data);
  CanFrameBytes out;
  static_assert(sizeof raw == sizeof out.bytes && CANFD_MTU == sizeof raw);
  out.count = frame.fd ? CANFD_MTU : CAN_MTU;
  std::memcpy(out.bytes.data(), &raw, out.count);
  return out;
}

std::optional<drivers::CanFrame> frame_of(drivers::Bytes bytes) {
  if (bytes.size() != CAN_MTU && bytes.size() != CANFD_MTU) return std::nullopt;
  canfd_frame raw{};
  std::memcpy(&raw, bytes.data(), bytes.size());
  drivers::CanFrame out;
  out.fd = bytes.size() == CANFD_MTU;
  out.error = (raw.can_id & CAN_ERR_FLAG) != 0;
  out.extended = !out.error && (raw.can_id & CAN_EFF_FLAG) != 0;
  out.remote = !out.error && (raw.can_id & CAN_RTR_FLAG) != 0;
  out.id = raw.can_id & (out.error || out.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  out.fd_flags = out.fd ? raw.flags : std::uint8_t{0};
  out.length = raw.len;
  if (out.length > (out.fd ? CANFD_MAX_DLEN : CAN_MAX_DLEN)) return std::nullopt;
  std::copy_n(raw.data, out.length, out.bytes.begin());
  return out;
}

}  // namespace imunoise::transport
