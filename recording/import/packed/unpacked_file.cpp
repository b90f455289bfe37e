#include "recording/import/packed/unpacked_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

#include "recording/import/packed/unpacking.h"
#include "recording/import/table/file.h"
#include "recording/import/table/sidecar.h"

namespace imunoise::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWriteBlock = std::size_t{1} << 20U;
constexpr std::array kPackedExtensions = {".gz", ".gzip", ".zst", ".zstd", ".bz2", ".lz4"};

fs::path name_inside(const fs::path& packed) {
  for (const char* const one : kPackedExtensions) {
    if (packed.extension() == one) return packed.stem();
  }
  return packed.filename();
}

tl::unexpected<Error> no_room(const fs::path& path, int error) {
  return fail(fmt::format("{}: cannot be unpacked into {}: {}; set TMPDIR to a folder with room",
                          path.string(), fs::temp_directory_path().string(),
                          std::generic_category().message(error)));
}

class Descriptor {
 public:
  explicit Descriptor(const fs::path& path)
      : number_(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool good() const { return number_ >= 0; }
  bool write(std::span<const char> bytes) const {
    while (!bytes.empty()) {
      const ssize_t wrote = ::write(number_, bytes.data(), bytes.size());
      if (wrote < 0 && errno == EINTR) continue;
      if (wrote <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(wrote));
    }
    return true;
  }

 private:
  int number_;
};

}  // namespace

Result<std::optional<UnpackedFile>> UnpackedFile::of(const fs::path& packed,
                                                     const std::function<bool()>& stopped) {
  std::optional<UnpackedFile> out;
  const Result<File> file = File::open(packed);
  if (!file) return tl::make_unexpected(file.error());
  std::array<char, 16> head = {};
  const Result<std::size_t> got = file->read_at(0, head);
  if (!got) return tl::make_unexpected(got.error());
  if (!packing_of({head.data(), *got})) return out;
  std::string pattern = (fs::temp_directory_path() / "imunoise-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) return no_room(packed, errno);
  out.emplace(UnpackedFile(packed, fs::path(pattern) / name_inside(packed)));
  if (auto filled = out->fill(stopped); !filled) return tl::make_unexpected(filled.error());
  return out;
}

Result<void> UnpackedFile::fill(const std::function<bool()>& stopped) {
  const Result<File> file = File::open(packed_);
  if (!file) return tl::make_unexpected(file.error());
  std::array<char, 16> head = {};
  const Result<std::size_t> known = file->read_at(0, head);
  if (!known) return tl::make_unexpected(known.error());
  const auto packing = packing_of({head.data(), *known});
  const auto stream =
      packing ? unpacking(*packing, std::make_unique<FileStream>(*file, 0, file->size()),
                          packed_.string())
              : nullptr;
  const Descriptor to(path_);
  if (!stream || !to.good()) return no_room(packed_, stream ? errno : ENOMEM);
  std::vector<char> block(kWriteBlock);
  std::uint64_t bytes = 0;
  while (true) {
    if (stopped()) return fail(fmt::format("{}: the import was stopped", packed_.string()));
    const Result<std::size_t> got = stream->read(block);
    if (!got) return tl::make_unexpected(got.error());
    if (*got == 0) break;
    bytes += *got;
    if (!to.write(std::span(block).first(*got))) return no_room(packed_, errno);
  }
  truncated_ = stream->truncated();
  if (bytes == 0) return fail(fmt::format("{}: holds nothing; copy it again", packed_.string()));
  std::error_code none;
  const fs::path sidecar = fs::absolute(sidecar_path(packed_.parent_path() / path_.filename()));
  if (fs::is_regular_file(sidecar, none)) fs::create_symlink(sidecar, sidecar_path(path_), none);
  return {};
}

UnpackedFile::UnpackedFile(UnpackedFile&& other) noexcept
    : packed_(std::move(other.packed_)),
      path_(std::exchange(other.path_, {})),
      truncated_(other.truncated_) {}

UnpackedFile::~UnpackedFile() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_.parent_path(), ignored);
}

std::string UnpackedFile::in_users_words(std::string message) const {
  const std::string here = path_.parent_path().string() + "/";
  const fs::path folder = packed_.parent_path();
  const std::string there = folder.empty() ? "" : (folder / "").string();
  for (std::size_t at = 0; (at = message.find(here, at)) != std::string::npos; at += there.size())
    message.replace(at, here.size(), there);
  return message;
}

}  // namespace imunoise::recording
