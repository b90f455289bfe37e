#pragma once

// A file system that tells which of its calls have not returned yet.

#include "recording/store/disk/disk_calls.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::recording {

/// Passes every call on. Thread-safe; `files` and `calls` outlive it, and it outlives the files it
/// creates.
class WatchedFiles final : public FileSystem {
 public:
  using Path = std::filesystem::path;

  WatchedFiles(FileSystem& files, DiskCalls& calls) : files_(files), calls_(calls) {}

  Result<std::unique_ptr<WritableFile>> create(const Path& path) override;
  Result<std::vector<std::string>> list(const Path& folder) const override;
  Result<bool> exists(const Path& path) const override;
  Result<std::uint64_t> free_space(const Path& path) const override;
  Result<void> rename(const Path& from, const Path& to) override;
  Result<void> remove(const Path& path) override;
  Result<void> make_folder(const Path& path) override;
  Result<void> sync_folder(const Path& path) override;
  Result<std::unique_ptr<FolderLock>> lock(const Path& folder) override;

 private:
  class File;

  Result<std::string> read_up_to(const Path& path, std::uint64_t limit) const override;

  FileSystem& files_;
  DiskCalls& calls_;
};

}  // namespace imunoise::recording
