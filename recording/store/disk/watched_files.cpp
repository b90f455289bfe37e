#include "recording/store/disk/watched_files.h"

#include <utility>

namespace imunoise::recording {

class WatchedFiles::File final : public WritableFile {
 public:
  File(DiskCalls& of, Path path, std::unique_ptr<WritableFile> file)
      : of_(of), path_(std::move(path)), file_(std::move(file)) {}

  Result<void> write(std::string_view bytes) override {
    const DiskCalls::Watch watch(of_, "write", path_);
    return file_->write(bytes);
  }
  Result<void> sync() override {
    const DiskCalls::Watch watch(of_, "sync", path_);
    return file_->sync();
  }

 private:
  DiskCalls& of_;
  Path path_;
  std::unique_ptr<WritableFile> file_;
};

Result<std::unique_ptr<WritableFile>> WatchedFiles::create(const Path& path) {
  const DiskCalls::Watch watch(calls_, "create", path);
  auto file = files_.create(path);
  if (!file) return file;
  return std::make_unique<File>(calls_, path, std::move(*file));
}

Result<std::string> WatchedFiles::read_up_to(const Path& path, std::uint64_t limit) const {
  const DiskCalls::Watch watch(calls_, "read", path);
  return files_.read(path, limit);
}

Result<std::vector<std::string>> WatchedFiles::list(const Path& folder) const {
  const DiskCalls::Watch watch(calls_, "list", folder);
  return files_.list(folder);
}

Result<bool> WatchedFiles::exists(const Path& path) const {
  const DiskCalls::Watch watch(calls_, "stat", path);
  return files_.exists(path);
}

Result<std::uint64_t> WatchedFiles::free_space(const Path& path) const {
  const DiskCalls::Watch watch(calls_, "statfs", path);
  return files_.free_space(path);
}

Result<void> WatchedFiles::rename(const Path& from, const Path& to) {
  const DiskCalls::Watch watch(calls_, "rename", to);
  return files_.rename(from, to);
}

Result<void> WatchedFiles::remove(const Path& path) {
  const DiskCalls::Watch watch(calls_, "remove", path);
  return files_.remove(path);
}

Result<void> WatchedFiles::make_folder(const Path& path) {
  const DiskCalls::Watch watch(calls_, "make_folder", path);
  return files_.make_folder(path);
}

Result<void> WatchedFiles::sync_folder(const Path& path) {
  const DiskCalls::Watch watch(calls_, "sync_folder", path);
  return files_.sync_folder(path);
}

Result<std::unique_ptr<FolderLock>> WatchedFiles::lock(const Path& folder) {
  const DiskCalls::Watch watch(calls_, "lock", folder);
  return files_.lock(folder);
}

}  // namespace imunoise::recording
