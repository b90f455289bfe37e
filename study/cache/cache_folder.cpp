#include "study/cache/cache_folder.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <utility>
#include <vector>

#include "recording/import/table/sidecar.h"
#include "recording/store/format/crc32c.h"
#include "study/cache/cache_record.h"

namespace imunoise::study {
namespace {

namespace fs = std::filesystem;

// To be raised whenever the same samples would be cut, mended or transformed otherwise, beside the
// program's own version.
constexpr int kVersion = 4;
constexpr std::string_view kSuffix = ".seen";
constexpr std::string_view kPartSuffix = ".part";  // write_cache_file()'s

// Identifies the contents of a file that is not being written.
std::string stamp(const fs::path& file) {
  struct stat at {};
  if (stat(file.c_str(), &at) != 0) return file.string() + " none\n";
  return fmt::format("{} {}.{} {} {}.{} {}.{}\n", file.string(), at.st_dev, at.st_ino, at.st_size,
                     at.st_mtim.tv_sec, at.st_mtim.tv_nsec, at.st_ctim.tv_sec, at.st_ctim.tv_nsec);
}

// A file and its sidecar; of a recording's folder every file in it. Nothing where one cannot be
// seen.
std::optional<std::string> stamps(const fs::path& path) {
  std::error_code wrong;
  if (!fs::is_directory(path, wrong)) return stamp(path) + stamp(recording::sidecar_path(path));
  std::vector<fs::path> all;
  fs::recursive_directory_iterator at(path, fs::directory_options::follow_directory_symlink, wrong);
  for (; !wrong && at != fs::recursive_directory_iterator(); at.increment(wrong)) {
    std::error_code nowhere;  // a link may lead there
    if (at->path().filename().string().starts_with('.')) {
      at.disable_recursion_pending();
    } else if (!at->is_directory(nowhere)) {
      all.push_back(at->path());
    }
  }
  if (wrong) return std::nullopt;
  std::sort(all.begin(), all.end());
  std::string out;
  for (const fs::path& file : all) out += stamp(file);
  return out;
}

// A folder of this user, and no link to one.
bool is_own(const fs::path& folder) {
  struct stat at {};
  return lstat(folder.c_str(), &at) == 0 && S_ISDIR(at.st_mode) && at.st_uid == geteuid();
}

// Deletes what was unused longest until there is room, and what a process left half written. False
// where the disk has none.
bool make_room(const fs::path& folder, std::uintmax_t bytes, std::uintmax_t most) {
  struct Kept {
    fs::file_time_type used;
    std::uintmax_t size;
    fs::path path;
  };
  constexpr std::chrono::hours kWritten{1};  // longer than any write
  const auto now = fs::file_time_type::clock::now();
  std::vector<Kept> all;
  std::uintmax_t total = bytes;
  std::error_code wrong;
  for (fs::directory_iterator at(folder, wrong), end; !wrong && at != end; at.increment(wrong)) {
    std::error_code gone;
    const Kept one{at->last_write_time(gone), at->file_size(gone), at->path()};
    if (gone) continue;
    if (one.path.extension() == kPartSuffix && one.used + kWritten < now) {
      fs::remove(one.path, gone);
    } else if (one.path.extension() == kSuffix) {
      all.push_back(one);
      total += one.size;
    }
  }
  std::sort(all.begin(), all.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
  for (const Kept& one : all) {
    if (total <= most) break;
    std::error_code gone;
    fs::remove(one.path, gone);
    total -= one.size;
  }
  const fs::space_info space = fs::space(folder, wrong);
  return !wrong && space.available / 4 > bytes;
}

fs::path file_in(const fs::path& folder, const std::string& name) {
  return folder / (recording::crc32c_text(name) + std::string(kSuffix));
}

// The file of this name that was made of files with these stamps, if it is there and whole.
std::optional<CacheFile> find_file(const fs::path& folder, const std::string& name,
                                   const std::string& stamps) {
  if (folder.empty() || !is_own(folder)) return std::nullopt;
  const fs::path path = file_in(folder, name);
  std::error_code ignored;
  if (!fs::is_regular_file(fs::symlink_status(path, ignored))) return std::nullopt;
  auto file = read_cache_file(path);
  if (!file || file->header.key() != name + stamps) return std::nullopt;
  fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);  // it was used
  return std::move(*file);
}

std::uintmax_t bytes_of(const CacheFile& file) {
  std::uintmax_t out = 0;
  for (const SharedVector& one : file.arrays)
    out += static_cast<std::uintmax_t>(one.size()) * sizeof(double);
  return out;
}

void keep_file(const CachePlace& place, const std::string& name, const std::string& stamps,
               CacheFile file) {
  if (place.folder.empty() || find_file(place.folder, name, stamps)) return;
  file.header.set_key(name + stamps);
  std::error_code wrong;
  fs::create_directories(place.folder, wrong);
  if (wrong || !is_own(place.folder)) return;
  if (make_room(place.folder, bytes_of(file), place.most_bytes))
    (void)write_cache_file(file_in(place.folder, name), file);
}

// With paths that mean the same wherever the program runs.
v1::StudyInput absolute(v1::StudyInput input) {
  for (std::string& file : *input.mutable_files())
    file = fs::absolute(file).lexically_normal().string();
  return input;
}

}  // namespace

fs::path user_cache_folder() {
  const char* const named = std::getenv("XDG_CACHE_HOME");  // NOLINT(concurrency-mt-unsafe)
  if (named != nullptr && *named == '/') return fs::path(named) / "imunoise";
  const char* const home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe)
  if (home != nullptr && *home == '/') return fs::path(home) / ".cache" / "imunoise";
  return {};
}

CacheFolder::CacheFolder(const v1::StudyInput& input, CachePlace place) : place_(std::move(place)) {
  const v1::StudyInput here = absolute(input);
  input_ = fmt::format("{} {}\n{}", IMUNOISE_VERSION, kVersion, here.SerializeAsString());
  for (const std::string& file : here.files()) {
    const auto of = stamps(file);
    if (!of) return;
    stamps_ += *of;
  }
}

std::string CacheFolder::name_of(const std::string& channel, const std::string& witness) const {
  return fmt::format("{}\n{}\n{}\n", input_, channel, witness);
}

std::optional<PreparedChannel> CacheFolder::find(const std::string& channel) const {
  const auto file = find_file(place_.folder, name_of(channel, ""), stamps_);
  return file ? channel_of(*file) : std::nullopt;
}

std::optional<Witness> CacheFolder::find_witness(const std::string& channel,
                                                 const std::string& witness) const {
  const auto file = find_file(place_.folder, name_of(channel, witness), stamps_);
  return file ? witness_of(*file) : std::nullopt;
}

void CacheFolder::keep(const PreparedChannel& prepared) const {
  CacheFile own = record_of(prepared);
  std::uintmax_t bytes = bytes_of(own);
  if (bytes > place_.most_bytes / 2) return;
  keep_file(place_, name_of(prepared.name, ""), stamps_, std::move(own));
  for (const Witness& witness : prepared.subject->witnesses) {
    CacheFile other = record_of(witness, prepared.subject->rate);
    bytes += bytes_of(other);
    if (bytes > place_.most_bytes / 2) return;
    keep_file(place_, name_of(prepared.name, witness.name), stamps_, std::move(other));
  }
}

}  // namespace imunoise::study
