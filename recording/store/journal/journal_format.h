#pragma once

// The bytes of a journal segment: frames of a length, a sequence number, a checksum and a message.
// Pure functions; docs/recording-format.md has the layout.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "recording/store/stream/stream.h"

namespace imunoise::recording {

/// No frame is longer: a larger length is damage.
inline constexpr std::uint32_t kMaximumPayload = std::uint32_t{1} << 28U;
inline constexpr std::uint64_t kHeaderSequence = 0;

/// One frame: magic "IMJ1", length, sequence, CRC-32C over length, sequence and payload; payload.
std::string frame(std::uint64_t sequence, std::string_view payload);

/// The frame that begins a segment.
std::string header_frame(const v1::JournalHeader& header);
/// The frame of a block. Precondition: check_block() accepted it.
std::string block_frame(std::uint64_t sequence, const Block& block);

/// Bytes that are no frame.
struct Damage {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  bool at_end = false;  ///< Nothing whole follows: an interrupted write looks like this.
};

/// Calls `use` for every whole frame, in order, and returns what lies between them. After damage it
/// searches on for the next whole frame. Linear in the size, whatever the bytes.
std::vector<Damage> scan_frames(
    std::string_view bytes,
    const std::function<void(std::uint64_t sequence, std::string_view payload)>& use);

/// Error: not a header that can be used, or of a later version of the format.
Result<v1::JournalHeader> parse_header(std::string_view payload);
/// Error: not a block of this device.
Result<Block> parse_block(const v1::RecordedDevice& device, std::string_view payload);

}  // namespace imunoise::recording
