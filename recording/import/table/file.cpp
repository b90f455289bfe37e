#include "recording/import/table/file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace imunoise::recording {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

}  // namespace

Result<File> File::open(const std::filesystem::path& path) {
  std::string name = path.string();
  // O_NONBLOCK: opening a pipe by mistake must not hang; it changes nothing for a regular file.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    return fail(fmt::format("{}: cannot be read: {}; check the path and its permissions", name,
                            reason(errno)));
  }
  struct stat facts = {};
  const bool known = ::fstat(descriptor, &facts) == 0;
  File file(descriptor, known ? static_cast<std::uint64_t>(facts.st_size) : 0, std::move(name));
  if (known && S_ISDIR(facts.st_mode)) {
    return fail(fmt::format("{}: is a folder; name the files in it", file.name_));
  }
  if (!known || !S_ISREG(facts.st_mode)) {
    return fail(
        fmt::format("{}: is not a regular file; save its data to a file first", file.name_));
  }
  return file;
}

File::File(File&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      name_(std::move(other.name_)) {}

File& File::operator=(File&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  std::swap(name_, other.name_);
  return *this;
}

File::~File() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<std::size_t> File::read_at(std::uint64_t offset, std::span<char> out) const {
  std::size_t done = 0;
  while (done < out.size()) {
    const ssize_t got = ::pread(descriptor_, out.data() + done, out.size() - done,
                                static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      return fail(fmt::format("{}: reading at byte {} failed: {}; check the disk or copy the file",
                              name_, offset + done, reason(errno)));
    }
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

}  // namespace imunoise::recording
