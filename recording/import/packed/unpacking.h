#pragma once

// Bytes that are unpacked while they are read: memory holds one block, whatever the file holds.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "recording/import/packed/byte_stream.h"

namespace imunoise::recording {

/// How bytes are packed.
enum class Packing {
  kGzip,     ///< members of gzip (RFC 1952)
  kZlib,     ///< RFC 1950
  kDeflate,  ///< RFC 1951, bare
  kZstd,     ///< frames of Zstandard
  kBzip2,    ///< streams of bzip2
  kLz4,      ///< frames of LZ4
};

/// How a file is packed as a whole, by its first bytes; nothing: it is not.
std::optional<Packing> packing_of(std::string_view head);

/// Unpacks the bytes of another stream; `name` is for messages. Null: the machine has no memory for
/// it.
std::unique_ptr<ByteStream> unpacking(Packing packing, std::unique_ptr<ByteStream> packed,
                                      std::string name);

}  // namespace imunoise::recording
