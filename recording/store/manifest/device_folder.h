#pragma once

// What lies in a recording's folders, and reading one chunk of it with every check.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "recording/store/chunk/chunk.h"
#include "recording/store/disk/file_system.h"

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

/// Checksums that a manifest lists, by the chunk's path inside the recording.
using Checksums = std::map<std::string, std::string>;

/// Makes a device's folder durably. Error: the disk's; it holds a recording already.
Result<DeviceFolder> make_device_folder(FileSystem& files, const std::filesystem::path& root,
                                        std::uint32_t replicate, const std::string& device);

/// The folders of all devices in all replicates, replicates in order. Error: a folder cannot be
/// listed.
Result<std::vector<DeviceFolder>> find_device_folders(const FileSystem& files,
                                                      const std::filesystem::path& root);
/// Those of one replicate; none when it has no folder.
Result<std::vector<DeviceFolder>> find_device_folders(const FileSystem& files,
                                                      const std::filesystem::path& root,
                                                      std::uint32_t replicate);

struct DeviceFiles {
  std::vector<std::uint64_t> chunks;    ///< Numbers, in order.
  std::vector<std::uint64_t> journals;  ///< Numbers, in order.
  std::vector<std::string> unfinished;  ///< Names of files whose writing was interrupted.
  std::vector<std::string> broken;      ///< Names of files that were set aside.
  std::uint64_t next_number = 1;        ///< No file has it, not even a broken one.
};
Result<DeviceFiles> list_device_files(const FileSystem& files, const DeviceFolder& where);

/// How the manifest lists a chunk file of these bytes.
v1::ChunkEntry chunk_entry(const std::string& file, const Chunk& chunk, std::string_view bytes);

/// A chunk, and how the manifest lists it.
struct ReadChunk {
  Chunk chunk;
  v1::ChunkEntry entry;
};

/// Why a chunk cannot be used.
struct ChunkTrouble {
  enum class Kind {
    kUnread,    ///< The disk's error: the contents of the file are unknown.
    kDamaged,   ///< Its bytes are no chunk, or not those that the manifest lists.
    kUnusable,  ///< Nothing shows damage: of another version of the format, or another folder.
  };
  Kind kind = Kind::kUnread;
  std::string message;  ///< "replicate-1/imu0: chunk 000012.h5: ..."
};

/// Reads chunk `number` once, for its checksum and its contents.
tl::expected<ReadChunk, ChunkTrouble> read_chunk(const FileSystem& files, const DeviceFolder& where,
                                                 std::uint64_t number, const Checksums& expected);

/// Renames `name` so that nothing reads it any more and nothing is lost; returns the new name.
Result<std::string> set_aside(FileSystem& files, const std::filesystem::path& folder,
                              const std::string& name);

/// The way out for chunk errors: "...; the 11 chunks before it are intact (imunoise verify --repair
/// keeps them)".
std::string keep_the_rest(std::size_t intact);

}  // namespace imunoise::recording
