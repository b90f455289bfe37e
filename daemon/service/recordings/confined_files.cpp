#include "daemon/service/recordings/confined_files.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

#include "core/support/descriptor.h"

namespace imunoise::service {
namespace {

using Path = std::filesystem::path;

tl::unexpected<Error> trouble(const Path& path, int error) {
  if (error == ELOOP || error == ENOTDIR)
    return fail(path.string() +
                ": a link, or below one; imunoise follows no links in data folders");
  return fail(path.string() + ": cannot be read: " + std::generic_category().message(error));
}

class ConfinedFiles final : public recording::FileSystem {
 public:
  explicit ConfinedFiles(std::vector<Path> folders) {
    for (const Path& one : folders) folders_.push_back(one.lexically_normal());
  }

  Result<std::string> read_up_to(const Path& path, std::uint64_t limit) const override {
    const auto file = open(path, O_RDONLY | O_NONBLOCK);
    if (!file) return tl::unexpected(file.error());
    struct stat found {};
    if (::fstat(file->get(), &found) != 0) return trouble(path, errno);
    if (!S_ISREG(found.st_mode)) return fail(path.string() + ": is not a regular file");
    const auto size = static_cast<std::size_t>(found.st_size);
    if (size > limit) return tl::make_unexpected(recording::too_large(path, limit));
    std::string out(size, '\0');
    std::size_t at = 0;
    while (at < out.size()) {
      const ssize_t got = ::read(file->get(), out.data() + at, out.size() - at);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return trouble(path, errno);
      if (got == 0) break;
      at += static_cast<std::size_t>(got);
    }
    out.resize(at);
    return out;
  }

  Result<std::vector<std::string>> list(const Path& folder) const override {
    auto opened = open(folder, O_RDONLY | O_DIRECTORY);
    if (!opened) return tl::unexpected(opened.error());
    const std::unique_ptr<DIR, int (*)(DIR*)> entries(::fdopendir(opened->get()), ::closedir);
    if (!entries) return trouble(folder, errno);
    const int at = opened->release();  // the stream's now
    std::vector<std::string> out;
    // NOLINTNEXTLINE(concurrency-mt-unsafe): this stream has no other reader.
    while (const dirent* const entry = ::readdir(entries.get())) {
      const std::string name = entry->d_name;
      struct stat found {};
      if (name == "." || name == ".." ||
          ::fstatat(at, name.c_str(), &found, AT_SYMLINK_NOFOLLOW) != 0 || S_ISLNK(found.st_mode)) {
        continue;
      }
      out.push_back(name + (S_ISDIR(found.st_mode) ? "/" : ""));
    }
    std::sort(out.begin(), out.end());
    return out;
  }

  Result<bool> exists(const Path& path) const override {
    const auto names = list(path.parent_path());
    if (!names) return tl::unexpected(names.error());
    const std::string name = path.filename().string();
    return std::any_of(names->begin(), names->end(),
                       [&](const std::string& one) { return one == name || one == name + "/"; });
  }

  Result<std::uint64_t> free_space(const Path& path) const override {
    return fail(path.string() + ": only its contents may be read here");
  }
  Result<std::unique_ptr<recording::WritableFile>> create(const Path& path) override {
    return refuse_to_write(path);
  }
  Result<void> rename(const Path&, const Path& to) override { return refuse_to_write(to); }
  Result<void> remove(const Path& path) override { return refuse_to_write(path); }
  Result<void> make_folder(const Path& path) override { return refuse_to_write(path); }
  Result<void> sync_folder(const Path& path) override { return refuse_to_write(path); }
  Result<std::unique_ptr<recording::FolderLock>> lock(const Path& folder) override {
    return refuse_to_write(folder);
  }

 private:
  static tl::unexpected<Error> refuse_to_write(const Path& path) {
    return fail(path.string() + ": may only be read here");
  }

  // The folder that the path lies in, and what leads from there to it.
  std::optional<std::pair<Path, Path>> place(const Path& path) const {
    if (std::find(path.begin(), path.end(), "..") != path.end()) return std::nullopt;
    for (const Path& folder : folders_) {
      const Path inside = path.lexically_normal().lexically_relative(folder);
      if (!inside.empty() && *inside.begin() != "..") return std::pair(folder, inside);
    }
    return std::nullopt;
  }

  Result<Descriptor> open(const Path& path, int flags) const {
    const auto where = place(path);
    if (!where) return fail(path.string() + ": is not in a folder of recordings");
    Descriptor at(::open(where->first.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    if (at.get() < 0) return trouble(path, errno);
    const auto last = std::prev(where->second.end());
    for (auto part = where->second.begin(); part != where->second.end(); ++part) {
      const int how = part == last ? flags : O_PATH | O_DIRECTORY;
      Descriptor next(::openat(at.get(), part->c_str(), how | O_NOFOLLOW | O_CLOEXEC));
      if (next.get() < 0) return trouble(path, errno);
      at = std::move(next);
    }
    return at;
  }

  std::vector<Path> folders_;
};

}  // namespace

std::unique_ptr<recording::FileSystem> confined_files(std::vector<Path> folders) {
  return std::make_unique<ConfinedFiles>(std::move(folders));
}

}  // namespace imunoise::service
