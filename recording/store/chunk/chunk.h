#pragma once

// A chunk: the samples of one device over some minutes, as the bytes of an HDF5 file with one group
// a stream. docs/recording-format.md has the layout.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "recording/store/stream/stream.h"

namespace imunoise::recording {

struct Chunk {
  std::uint32_t replicate = 1;
  v1::RecordedDevice device;
  std::uint64_t first_sequence = 0;  ///< Journal blocks that it holds, both ends inclusive.
  std::uint64_t last_sequence = 0;
  std::vector<Rows> streams;  ///< As RecordedDevice.streams.
};

/// Rows of all streams.
std::uint64_t row_count(const Chunk& chunk);

/// The bytes of the file. Error, without the file's name: HDF5 cannot, for
/// want of memory. Precondition: check_device() and check_block() accepted what is in it.
Result<std::string> encode_chunk(const Chunk& chunk);

/// True when these are the bytes of a chunk, whole or not, of another version of the format.
bool chunk_of_other_version(std::string_view bytes);
/// The same blocks, streams, counts and rows, bit by bit; texts are not compared.
bool same_samples(const Chunk& a, const Chunk& b);

/// Error, without the file's name: damage, with the dataset where it is; not a chunk; another
/// version. HDF5's own checksums guard every number and name.
Result<Chunk> decode_chunk(std::string_view bytes);

}  // namespace imunoise::recording
