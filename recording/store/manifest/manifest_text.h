#pragma once

// The text of manifests: one of a recording, one of each replicate.

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "recording/store/manifest/device_folder.h"

namespace imunoise::recording {

/// manifest.json as it was read.
struct RecordingManifestFile {
  v1::RecordingManifest recording;
  /// Of version 1, which had everything in this file: its replicates. Files of their own count for
  /// nothing beside it: a conversion to version 2 came to no end.
  std::optional<std::map<std::uint32_t, v1::ReplicateManifest>> replicates;
};

/// `file` is for messages. Error: a newer version, which the message says first of all; not JSON,
/// an unknown field, a device that cannot be, a chunk's path that leaves the folder.
Result<RecordingManifestFile> parse_recording_manifest(std::string_view file,
                                                       std::string_view json);
/// As above; of replicate `replicate`, whose chunks alone it may name.
Result<v1::ReplicateManifest> parse_replicate_manifest(std::string_view file, std::string_view json,
                                                       std::uint32_t replicate);
/// Any of the messages as the text of a file.
std::string print_manifest(const google::protobuf::Message& manifest);
/// True for a manifest of a version that this program does not read: nothing may be repaired then.
bool of_other_version(std::string_view json);

/// The inverse of whole_manifest(), of any number of replicates.
RecordingManifestFile split_manifest(const v1::Manifest& whole);

}  // namespace imunoise::recording
