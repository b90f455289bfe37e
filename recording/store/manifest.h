#pragma once

// manifest.json: what a recording is, and which chunks belong to it. Chunks are authoritative; a
// manifest that is lost is made again from them.

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "recording/store/device_folder.h"

namespace imunoise::recording {

/// `file` is for messages. Error: not JSON, an unknown field, another version, a device that cannot
/// be, a chunk's path that leaves the folder.
Result<v1::Manifest> parse_manifest(std::string_view file, std::string_view json);
std::string print_manifest(const v1::Manifest& manifest);

/// Nothing when there is none.
Result<std::optional<v1::Manifest>> read_manifest(const FileSystem& files,
                                                  const std::filesystem::path& root);
/// The same before it is parsed. Error: the disk's, or a file too large to be a manifest.
Result<std::optional<std::string>> read_manifest_text(const FileSystem& files,
                                                      const std::filesystem::path& root);
/// True for a manifest of another version of the format: nothing may be repaired then.
bool of_other_version(const std::string& json);
/// Replaces the manifest; after a power cut there is the old or the new one.
Result<void> write_manifest(FileSystem& files, const std::filesystem::path& root,
                            const v1::Manifest& manifest);

/// Adds the device unless it is listed; what is listed stays.
void add_device(v1::Manifest& manifest, const v1::RecordedDevice& device);

/// Replaces the note of its replicate, or adds it, in order.
void set_note(v1::Manifest& manifest, const v1::ReplicateNote& note);
/// Replicates that are open while nobody records them were interrupted.
void end_open_replicates(v1::Manifest& manifest, const std::string& reason = {});

/// In order of replicates and file names.
void sort_chunks(v1::Manifest& manifest);

/// Replaces the record of the same file, or adds it, in order.
void set_damaged(v1::Manifest& manifest, const v1::DamagedFile& damaged);

/// Folders that hold something, as the manifest says: "replicate-1/imu0".
std::set<std::string> promised_folders(const v1::Manifest& manifest);

Checksums checksums(const v1::Manifest& manifest);

/// What changes when a chunk is added, lost or replaced: CRC-32C of all chunks' names and
/// checksums, 8 hexadecimal digits.
std::string fingerprint(const v1::Manifest& manifest);

}  // namespace imunoise::recording
