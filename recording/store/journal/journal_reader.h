#pragma once

// A journal segment as the chunk that it will become.

#include <optional>
#include <string_view>
#include <vector>

#include "recording/store/chunk/chunk.h"
#include "recording/store/journal/journal_format.h"

namespace imunoise::recording {

/// What a segment holds beyond `after`, the last block that is in a chunk already.
struct Segment {
  std::optional<Chunk> chunk;     ///< Nothing when there is no such block.
  std::vector<Damage> damage;     ///< Bytes that are no frame.
  std::uint64_t lost_blocks = 0;  ///< Blocks between the first and the last that are not there.
  std::uint64_t unusable = 0;     ///< Whole frames whose message is not a block of this device.
};

/// Greater than every block's number.
inline constexpr std::uint64_t kNoBlock = UINT64_MAX;

/// Reads a segment, without blocks numbered `before` or higher, which are in a chunk. Blocks come
/// once each, in the order of their sequence numbers; rows that follow missing blocks (also between
/// `after` and the first one) carry kLostBefore. When the segment's own header is damaged,
/// `fallback`, a header of the same device's journal, takes its place; without one no frame is
/// usable. Error, without the file's name: a header of another version, which must be left alone.
Result<Segment> read_segment(std::string_view bytes, std::uint64_t after,
                             const v1::JournalHeader* fallback, std::uint64_t before = kNoBlock);

}  // namespace imunoise::recording
