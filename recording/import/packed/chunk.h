#pragma once

// Packed bytes inside a bag, unpacked within a stated bound.

#include <cstdint>
#include <string>
#include <string_view>

#include "core/support/result.h"

namespace imunoise::recording {

/// No chunk of a bag may unpack to more bytes.
inline constexpr std::uint64_t kLargestChunk = std::uint64_t{256} << 20U;

/// What came out of packed bytes: all of it, or what stood before they broke off.
struct Unpacked {
  std::string bytes;
  bool whole = false;
};

/// Unpacks `packed`, whose method the bag calls "" or "none", "lz4" (frames), "zstd" or "bz2", into
/// at most `size` bytes. Error, without the file's name: an unknown method, more than
/// kLargestChunk bytes announced.
Result<Unpacked> unpack_chunk(std::string_view method, std::string_view packed, std::uint64_t size);

}  // namespace imunoise::recording
