#pragma once

// A journal segment becomes a chunk: the same code while recording and after a crash.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "recording/store/journal/journal_reader.h"
#include "recording/store/manifest/device_folder.h"

namespace imunoise::recording {

struct Sealed {
  std::optional<v1::ChunkEntry> entry;  ///< The chunk; nothing when the segment had nothing new.
  std::optional<Chunk> chunk;           ///< What is in it.
  std::optional<std::string> damage;    ///< What of the segment was not readable.
  bool torn = false;                    ///< The damage is its end only: an interrupted write.
  std::string kept_as;                  ///< With damage: the segment's new name.
};

/// Writes the blocks of segment `number` that lie between `after` and `before` as chunk `number`,
/// reads it back from the disk, compares every sample, puts it in place durably, and only then
/// removes the segment (sets it aside when part of it was damaged). May be repeated after an error
/// or a crash at any point. `fallback` and `before` as for read_segment().
Result<Sealed> seal_segment(FileSystem& files, const DeviceFolder& where, std::uint64_t number,
                            std::uint64_t after, const v1::JournalHeader* fallback = nullptr,
                            std::uint64_t before = kNoBlock);

/// The damage of segment `number`, for the manifest. Precondition: there is some.
v1::DamagedFile damaged_segment(const DeviceFolder& where, std::uint64_t number,
                                const Sealed& sealed);

}  // namespace imunoise::recording
