#pragma once

// A journal segment becomes a chunk: the same code while recording and after a crash.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "recording/store/chunk_file.h"
#include "recording/store/file_system.h"
#include "recording/store/journal_reader.h"

namespace imunoise::recording {

/// The folder of one device in one replicate.
struct DeviceFolder {
  std::filesystem::path root;  ///< Of the recording.
  std::string folder;          ///< "replicate-1/imu0", as the manifest writes it.

  std::filesystem::path path() const { return root / folder; }
  std::uint32_t replicate() const;
  std::string device() const;
  std::string file(const std::string& name) const { return folder + "/" + name; }
};

struct Sealed {
  std::optional<v1::ChunkEntry> entry;  ///< The chunk; nothing when the segment had nothing new.
  std::optional<Chunk> chunk;           ///< What is in it.
  std::optional<std::string> damage;    ///< What of the segment was not readable.
  bool torn = false;                    ///< The damage is its end only: an interrupted write.
  std::string kept_as;                  ///< With damage: the segment's new name.
};

/// How the manifest lists a chunk file of these bytes.
v1::ChunkEntry chunk_entry(const std::string& file, const Chunk& chunk, std::string_view bytes);

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

/// Renames `name` so that nothing reads it any more and nothing is lost; returns the new name.
Result<std::string> set_aside(FileSystem& files, const std::filesystem::path& folder,
                              const std::string& name);

}  // namespace imunoise::recording
