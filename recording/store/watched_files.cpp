#include "recording/store/watched_files.h"

#include <utility>

namespace imunoise::recording {

// One call, from its begin to its end.
class WatchedFiles::Watch {
 public:
  Watch(const WatchedFiles& of, std::string_view what, const Path& path) : of_(of) {
    const std::lock_guard guard(of_.mutex_);
    place_ = of_.calls_.insert(of_.calls_.end(), {what, path, std::chrono::steady_clock::now()});
  }
  ~Watch() {
    const std::lock_guard guard(of_.mutex_);
    of_.calls_.erase(place_);
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

 private:
  const WatchedFiles& of_;
  std::list<DiskCall>::iterator place_;
};

class WatchedFiles::File final : public WritableFile {
 public:
  File(const WatchedFiles& of, Path path, std::unique_ptr<WritableFile> file)
      : of_(of), path_(std::move(path)), file_(std::move(file)) {}

  Result<void> write(std::string_view bytes) override {
    const Watch watch(of_, "write", path_);
    return file_->write(bytes);
  }
  Result<void> sync() override {
    const Watch watch(of_, "sync", path_);
    return file_->sync();
  }

 private:
  const WatchedFiles& of_;
  Path path_;
  std::unique_ptr<WritableFile> file_;
};

Result<std::unique_ptr<WritableFile>> WatchedFiles::create(const Path& path) {
  const Watch watch(*this, "create", path);
  auto file = files_.create(path);
  if (!file) return file;
  return std::make_unique<File>(*this, path, std::move(*file));
}

Result<std::string> WatchedFiles::read_up_to(const Path& path, std::uint64_t limit) const {
  const Watch watch(*this, "read", path);
  return files_.read(path, limit);
}

Result<std::vector<std::string>> WatchedFiles::list(const Path& folder) const {
  const Watch watch(*this, "list", folder);
  return files_.list(folder);
}

Result<bool> WatchedFiles::exists(const Path& path) const {
  const Watch watch(*this, "stat", path);
  return files_.exists(path);
}

Result<void> WatchedFiles::rename(const Path& from, const Path& to) {
  const Watch watch(*this, "rename", to);
  return files_.rename(from, to);
}

Result<void> WatchedFiles::remove(const Path& path) {
  const Watch watch(*this, "remove", path);
  return files_.remove(path);
}

Result<void> WatchedFiles::make_folder(const Path& path) {
  const Watch watch(*this, "make_folder", path);
  return files_.make_folder(path);
}

Result<void> WatchedFiles::sync_folder(const Path& path) {
  const Watch watch(*this, "sync_folder", path);
  return files_.sync_folder(path);
}

Result<std::unique_ptr<FolderLock>> WatchedFiles::lock(const Path& folder) {
  const Watch watch(*this, "lock", folder);
  return files_.lock(folder);
}

std::vector<DiskCall> WatchedFiles::calls() const {
  const std::lock_guard guard(mutex_);
  return {calls_.begin(), calls_.end()};
}

}  // namespace imunoise::recording
