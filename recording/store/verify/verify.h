#pragma once

// Looks through a whole recording, and repairs what can be repaired.

#include <filesystem>

#include "imunoise/v1/recording.pb.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::recording {

/// Reads every chunk, journal and the manifest. Changes nothing unless `repair`: then the tail of a
/// journal becomes a chunk, a damaged chunk is set aside (never deleted), a manifest that is lost
/// or out of date is made from the chunks. Error: not a recording, the disk's, another process is
/// recording (repair only). Memory: the samples of one device in one replicate.
Result<v1::VerifyReport> verify_recording(FileSystem& files, const std::filesystem::path& folder,
                                          bool repair);

/// The same for one chunk file by itself.
Result<v1::VerifyReport> verify_chunk(const FileSystem& files, const std::filesystem::path& file);

}  // namespace imunoise::recording
