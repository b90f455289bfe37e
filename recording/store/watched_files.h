#pragma once

// A file system that tells which calls have not returned yet: a disk that hangs returns no error.

#include <chrono>
#include <list>
#include <mutex>
#include <string_view>

#include "recording/store/file_system.h"

namespace imunoise::recording {

/// A call of the file system that has not returned.
struct DiskCall {
  std::string_view what;  ///< "write", "sync", "rename", ...
  std::filesystem::path path;
  std::chrono::steady_clock::time_point since;
};

/// Passes every call on. Thread-safe; `files` outlives it, and it outlives the files it creates.
class WatchedFiles final : public FileSystem {
 public:
  using Path = std::filesystem::path;

  explicit WatchedFiles(FileSystem& files) : files_(files) {}

  Result<std::unique_ptr<WritableFile>> create(const Path& path) override;
  Result<std::vector<std::string>> list(const Path& folder) const override;
  Result<bool> exists(const Path& path) const override;
  Result<void> rename(const Path& from, const Path& to) override;
  Result<void> remove(const Path& path) override;
  Result<void> make_folder(const Path& path) override;
  Result<void> sync_folder(const Path& path) override;
  Result<std::unique_ptr<FolderLock>> lock(const Path& folder) override;

  /// Those in progress, the oldest first.
  std::vector<DiskCall> calls() const;

 private:
  class File;
  class Watch;

  Result<std::string> read_up_to(const Path& path, std::uint64_t limit) const override;

  FileSystem& files_;
  mutable std::mutex mutex_;
  mutable std::list<DiskCall> calls_;
};

}  // namespace imunoise::recording
