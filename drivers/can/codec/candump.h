#pragma once

// Lines as `candump -L` writes and `log2asc`, `canplayer` read them: "(sec.usec) can0
// 123#DEADBEEF". Source: can-utils.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/can/codec/frame.h"

namespace imunoise::drivers {

enum class CanDirection : std::uint8_t { kUnknown, kReceived, kSent };

/// A frame, when and where it was seen. The interface's name is borrowed from the line.
struct CandumpLine {
  std::int64_t time_ns = 0;  ///< Since 1970-01-01 UTC, as the recording host's clock said.
  std::string_view interface;
  CanFrame frame;
  CanDirection direction = CanDirection::kUnknown;  ///< Suffix " R" or " T".
};

/// Reads one line without its ending: three digits of identifier for 11 bits, eight for 29; "R" for
/// remote frames, "##" for CAN FD, an identifier with bit 29 for error frames. Nothing if it is no
/// such line.
std::optional<CandumpLine> parse_candump_line(std::string_view line);

/// The line, without its ending, that parse_candump_line() reads back.
std::string format_candump_line(const CandumpLine& line);

}  // namespace imunoise::drivers
