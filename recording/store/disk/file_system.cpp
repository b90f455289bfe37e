#include "recording/store/disk/file_system.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "core/support/descriptor.h"
#include "recording/import/table/file.h"

namespace imunoise::recording {
namespace {

using Path = std::filesystem::path;

tl::unexpected<Error> trouble(const Path& path, std::string_view what, int error) {
  std::string_view way_out = "check the disk and the permissions";
  if (error == ENOSPC || error == EDQUOT) way_out = "free some space";
  if (error == EROFS) way_out = "record to a disk that can be written";
  if (error == EIO) way_out = "the disk fails: copy what is on it to another one";
  return fail(fmt::format("{}: {}: {}; {}", path.string(), what,
                          std::generic_category().message(error), way_out));
}

class PosixFile final : public WritableFile {
 public:
  PosixFile(Path path, Descriptor descriptor)
      : path_(std::move(path)), descriptor_(std::move(descriptor)) {}

  Result<void> write(std::string_view bytes) override {
    while (!bytes.empty()) {
      const ssize_t done = ::write(descriptor_.get(), bytes.data(), bytes.size());
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) return trouble(path_, "cannot be written", errno);
      bytes.remove_prefix(static_cast<std::size_t>(done));
    }
    return {};
  }
  Result<void> sync() override {
    if (::fdatasync(descriptor_.get()) == 0) return {};
    return trouble(path_, "cannot be synced", errno);
  }

 private:
  Path path_;
  Descriptor descriptor_;
};

// What a name in a folder stands for; links are followed, one that leads nowhere is no folder.
Result<bool> is_folder(const Path& folder, const dirent& entry) {
  if (entry.d_type == DT_DIR) return true;
  if (entry.d_type == DT_REG) return false;
  struct stat found {};
  const Path path = folder / entry.d_name;
  if (::stat(path.c_str(), &found) == 0) return S_ISDIR(found.st_mode);
  if (errno == ENOENT) return false;
  return trouble(path, "cannot be looked at", errno);
}

class PosixLock final : public FolderLock {
 public:
  explicit PosixLock(Descriptor descriptor) : descriptor_(std::move(descriptor)) {}

 private:
  Descriptor descriptor_;
};

class PosixFileSystem final : public FileSystem {
 public:
  Result<std::unique_ptr<WritableFile>> create(const Path& path) override {
    Descriptor descriptor(
        ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644));
    if (descriptor.get() < 0) return trouble(path, "cannot be created", errno);
    return std::make_unique<PosixFile>(path, std::move(descriptor));
  }

  Result<std::string> read_up_to(const Path& path, std::uint64_t limit) const override {
    const Result<File> file = File::open(path);
    if (!file) return tl::make_unexpected(file.error());
    if (file->size() > limit) return tl::make_unexpected(too_large(path, limit));
    std::string out(file->size(), '\0');
    const Result<std::size_t> got = file->read_at(0, out);
    if (!got) return tl::make_unexpected(got.error());
    out.resize(*got);
    return out;
  }

  Result<std::vector<std::string>> list(const Path& folder) const override {
    std::vector<std::string> out;
    const std::unique_ptr<DIR, int (*)(DIR*)> open(::opendir(folder.c_str()), ::closedir);
    if (!open) return trouble(folder, "cannot be listed", errno);
    errno = 0;
    // NOLINTNEXTLINE(concurrency-mt-unsafe): each call has a stream of its own
    while (const dirent* const entry = ::readdir(open.get())) {
      const std::string_view name = entry->d_name;
      if (name == "." || name == "..") continue;
      const auto inner = is_folder(folder, *entry);
      if (!inner) return tl::make_unexpected(inner.error());
      out.emplace_back(name) += *inner ? "/" : "";
      errno = 0;
    }
    if (errno != 0) return trouble(folder, "cannot be listed", errno);
    std::sort(out.begin(), out.end());
    return out;
  }

  Result<void> rename(const Path& from, const Path& to) override {
    if (::rename(from.c_str(), to.c_str()) == 0) return {};
    return trouble(to, "cannot be renamed into place", errno);
  }

  Result<void> remove(const Path& path) override {
    if (::unlink(path.c_str()) == 0) return {};
    if (errno == EISDIR && ::rmdir(path.c_str()) == 0) return {};
    return trouble(path, "cannot be removed", errno);
  }

  Result<std::uint64_t> free_space(const Path& path) const override {
    Path place = path;
    struct statvfs found {};
    while (::statvfs(place.c_str(), &found) != 0) {
      if (errno == EINTR) continue;
      const Path above = place.has_parent_path() ? place.parent_path() : Path(".");
      const bool absent = errno == ENOENT || errno == ENOTDIR;
      if (!absent || above == place)
        return trouble(place, "its free space cannot be determined", errno);
      place = above;
    }
    return std::uint64_t{found.f_bavail} * found.f_frsize;
  }

  Result<bool> exists(const Path& path) const override {
    struct stat found {};
    if (::stat(path.c_str(), &found) == 0) return true;
    if (errno == ENOENT || errno == ENOTDIR) return false;
    return trouble(path, "cannot be looked at", errno);
  }

  Result<void> make_folder(const Path& path) override {
    if (::mkdir(path.c_str(), 0755) == 0 || errno == EEXIST) return {};
    return trouble(path, "cannot be made", errno);
  }

  Result<void> sync_folder(const Path& path) override {
    const Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (descriptor.get() >= 0 && ::fsync(descriptor.get()) == 0) return {};
    return trouble(path, "cannot be synced", errno);
  }

  Result<std::unique_ptr<FolderLock>> lock(const Path& folder) override {
    Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (descriptor.get() < 0) return trouble(folder, "cannot be opened", errno);
    if (::flock(descriptor.get(), LOCK_EX | LOCK_NB) == 0) {
      return std::make_unique<PosixLock>(std::move(descriptor));
    }
    if (errno != EWOULDBLOCK) return trouble(folder, "cannot be locked", errno);
    return fail(fmt::format("{}: another process is recording into it; wait until it has ended",
                            folder.string()));
  }
};

}  // namespace

FileSystem& posix_file_system() {
  static PosixFileSystem files;
  return files;
}

Error too_large(const Path& path, std::uint64_t limit) {
  return {
      fmt::format("{}: is larger than {} bytes, no file of a recording is; replace it by a copy",
                  path.string(), limit)};
}

Result<void> replace_file(FileSystem& files, const Path& path, std::string_view bytes,
                          const ReadBack& check) {
  Path part = path;
  part += kPartSuffix;
  {
    const auto file = files.create(part);
    if (!file) return tl::make_unexpected(file.error());
    if (auto done = (*file)->write(bytes); !done) return done;
    if (auto done = (*file)->sync(); !done) return done;
  }
  if (check) {
    const auto back = files.read(part);
    if (!back) return tl::make_unexpected(back.error());
    if (auto good = check(*back); !good) return good;
  }
  if (auto done = files.rename(part, path); !done) return done;
  return files.sync_folder(path.parent_path());
}

Result<void> make_folders(FileSystem& files, const Path& path) {
  const auto there = files.exists(path);
  if (!there) return tl::make_unexpected(there.error());
  if (*there) return {};
  const Path above = path.has_parent_path() ? path.parent_path() : Path(".");
  if (auto done = make_folders(files, above); !done) return done;
  if (auto done = files.make_folder(path); !done) return done;
  return files.sync_folder(above);
}

Result<void> remove_tree(FileSystem& files, const Path& folder) {
  const auto names = files.list(folder);
  if (!names) return tl::make_unexpected(names.error());
  for (const std::string& name : *names) {
    const bool is_folder = name.ends_with('/');
    const Path inner = folder / (is_folder ? name.substr(0, name.size() - 1) : name);
    auto done = files.remove(inner);  // also a link to a folder
    if (!done && is_folder) done = remove_tree(files, inner);
    if (!done) return done;
  }
  return files.remove(folder);
}

Result<bool> contains(const FileSystem& files, const Path& folder, std::string_view name) {
  const auto names = files.list(folder);
  if (!names) return tl::make_unexpected(names.error());
  return std::find(names->begin(), names->end(), name) != names->end();
}

}  // namespace imunoise::recording
