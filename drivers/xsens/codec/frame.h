#pragma once

// Xbus frames: FA FF MID LEN [LEN16] DATA CS. After the FA all bytes sum to 0 modulo 256. Source:
// Xsens MT0101P 2020.A, section 5.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/codec/bytes.h"
#include "drivers/codec/refusal.h"

namespace imunoise::drivers {

inline constexpr std::size_t kXbusMaximumPayload = 2048;  // bytes

/// A whole frame with a correct checksum. The payload is borrowed.
struct XbusFrame {
  std::uint8_t message_id = 0;
  Bytes payload;
};

/// The frame's bytes. Precondition: at most kXbusMaximumPayload bytes of payload.
std::vector<std::uint8_t> encode_xbus_frame(std::uint8_t message_id, Bytes payload);

/// Finds frames among bytes. A frame that turns out wrong costs only its first byte: the search
/// goes on from the byte after its FA, so that a false preamble hides no true frame. Memory: what
/// was pushed and not yet asked for, and at most one frame. One thread at a time.
class XbusParser {
 public:
  void push(Bytes bytes);
  /// There are no more bytes: a frame that is still open is truncated.
  void finish() { finished_ = true; }
  /// The next frame, valid until the next push(); nothing when more bytes are needed.
  std::optional<XbusFrame> next();

  const Refusals& refused() const { return refused_; }

 private:
  // Refuses the frame that seems to begin here.
  void refuse(Refusal reason);

  std::vector<std::uint8_t> buffer_;
  std::size_t begin_ = 0;  // bytes before it are done with
  bool finished_ = false;
  Refusals refused_;
};

}  // namespace imunoise::drivers
