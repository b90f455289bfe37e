#pragma once

// The files of recordings, as the service may see them: for reading only, beneath their folders,
// and through no link.

#include <memory>

#include "recording/store/disk/file_system.h"

namespace imunoise::service {

/// Reads and lists beneath any of the folders. Links may lead to a folder itself, but below it a
/// link is no file: it is neither listed nor read. Everything that would write is an error, and so
/// are paths that lie elsewhere or hold "..", and what is no regular file. Thread-safe.
std::unique_ptr<recording::FileSystem> confined_files(std::vector<std::filesystem::path> folders);

}  // namespace imunoise::service
