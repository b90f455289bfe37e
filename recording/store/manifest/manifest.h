#pragma once

// What a recording is, and which chunks belong to it: manifest.json has what the replicates have in
// common, replicate-N.json what one of them holds, so that a replicate costs the same however many
// came before. Chunks are authoritative; a manifest that is lost is made again from them.

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "recording/store/manifest/device_folder.h"
#include "recording/store/manifest/manifest_text.h"

namespace imunoise::recording {

/// The text of a manifest. Error: the disk's, or a file too large to be a manifest.
Result<std::string> read_manifest_text(const FileSystem& files, const std::filesystem::path& file);
/// Replaces a manifest; after a power cut there is the old or the new one. The version is set.
Result<void> write_recording_manifest(FileSystem& files, const std::filesystem::path& root,
                                      v1::RecordingManifest& manifest);
Result<void> write_replicate_manifest(FileSystem& files, const std::filesystem::path& root,
                                      std::uint32_t replicate, v1::ReplicateManifest& manifest);

/// The whole manifest, and what of it is lost.
struct WholeManifest {
  v1::Manifest manifest;
  std::set<std::uint32_t> replicates;  ///< Those with a manifest; of version 1: all in the file.
  std::set<std::uint32_t> missing;     ///< Those that should have one.
  std::vector<std::string> defects;    ///< Of replicates' manifests; each with the way out.
};
/// Reads all manifests of a recording; nothing when there is no manifest.json. Error: the disk's,
/// or that of manifest.json.
Result<std::optional<WholeManifest>> read_whole_manifest(const FileSystem& files,
                                                         const std::filesystem::path& root);
/// The same where all of it is needed: a defect is an error.
Result<std::optional<v1::Manifest>> read_manifest(const FileSystem& files,
                                                  const std::filesystem::path& root);
/// Changes when any of the manifests does. What cannot be read is told when it is understood.
std::string manifest_stamp(const FileSystem& files, const std::filesystem::path& root);

/// The whole of a recording whose only replicate this is.
v1::Manifest whole_manifest(const v1::RecordingManifest& recording,
                            const v1::ReplicateManifest& replicate);
/// Error: a device of another serial number is listed by this name.
Result<void> check_same(const v1::RecordingManifest& manifest, const v1::RecordedDevice& device);
/// Adds the device unless it is listed; what is listed stays.
void add_device(v1::RecordingManifest& manifest, const v1::RecordedDevice& device);

/// A replicate that is open while no recorder holds the folder was interrupted.
void end_open_replicate(v1::ReplicateNote& note, const std::string& reason);

/// In order of their names.
void sort_chunks(v1::ReplicateManifest& manifest);

/// Replaces the record of the same file, or adds it, in order.
void set_damaged(google::protobuf::RepeatedPtrField<v1::DamagedFile>& all,
                 const v1::DamagedFile& damaged);

/// Folders that hold something, as the manifest says: "replicate-1/imu0".
std::set<std::string> promised_folders(const v1::Manifest& manifest);

Checksums checksums(const v1::Manifest& manifest);

/// What changes when a chunk is added, lost or replaced: CRC-32C of all chunks' names and
/// checksums, 8 hexadecimal digits.
std::string fingerprint(const v1::Manifest& manifest);

}  // namespace imunoise::recording
