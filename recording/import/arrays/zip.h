#pragma once

// Members of a ZIP archive. Source: PKWARE, APPNOTE 6.3.10, sections 4.3.7, 4.3.12, 4.3.14
// to 4.3.16 and 4.5.3.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "recording/import/packed/byte_stream.h"

namespace imunoise::recording {

struct ZipMember {
  std::string name;
  std::uint16_t method = 0;  ///< 0 as it is, 8 deflated
  std::uint64_t packed = 0;  ///< bytes in the archive
  std::uint64_t bytes = 0;   ///< bytes that come out
  std::uint64_t header = 0;  ///< place of its local header
};

/// The members, as the directory at the archive's end lists them. Error: there is none (a truncated
/// archive), or it is damaged.
Result<std::vector<ZipMember>> zip_members(const File& file);

/// A member's bytes, which borrow the file. Error: encrypted, packed in another way, damaged.
Result<std::unique_ptr<ByteStream>> open_member(const File& file, const ZipMember& member);

}  // namespace imunoise::recording
