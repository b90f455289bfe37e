#pragma once

// Every file system call of the store, behind one small interface: tests put a disk in its place
// that is full, that fails, or that forgets what was not synced.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"

namespace imunoise::recording {

/// A file being written, from its beginning on. Closed when destroyed.
class WritableFile {
 public:
  virtual ~WritableFile() = default;
  /// Appends all bytes. Error: some of them may be in the file.
  virtual Result<void> write(std::string_view bytes) = 0;
  /// When it succeeds, the file's contents survive a power cut (fdatasync). After an error it is
  /// unknown which bytes do: do not try again on this file.
  virtual Result<void> sync() = 0;
};

/// Held while a recording is being written; given up when destroyed, or when the process dies.
class FolderLock {
 public:
  virtual ~FolderLock() = default;
};

/// No file of ours is larger: a length beyond it is no length but damage, or a trap.
inline constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 33U;  // bytes

/// Errors name the file, what failed and the way out. Functions are thread-safe.
class FileSystem {
 public:
  virtual ~FileSystem() = default;

  /// A new file, or an existing one made empty. Its name survives a power cut only after
  /// sync_folder().
  virtual Result<std::unique_ptr<WritableFile>> create(const std::filesystem::path& path) = 0;
  /// The whole contents of a regular file. Error: the disk's, or more than `limit` bytes; a sparse
  /// file may claim any length.
  Result<std::string> read(const std::filesystem::path& path,
                           std::uint64_t limit = kLargestFile) const {
    return read_up_to(path, limit);
  }
  /// Names in a folder, sorted; those of folders end in '/'.
  virtual Result<std::vector<std::string>> list(const std::filesystem::path& folder) const = 0;
  /// Whether there is something of this name. Error: the disk's, which is no answer.
  virtual Result<bool> exists(const std::filesystem::path& path) const = 0;
  /// Bytes that are free for us on the disk of the path, or of the nearest folder above it that
  /// exists.
  virtual Result<std::uint64_t> free_space(const std::filesystem::path& path) const = 0;
  /// Replaces `to` when it exists.
  virtual Result<void> rename(const std::filesystem::path& from,
                              const std::filesystem::path& to) = 0;
  /// A file, or an empty folder.
  virtual Result<void> remove(const std::filesystem::path& path) = 0;
  /// One folder; not an error when it exists.
  virtual Result<void> make_folder(const std::filesystem::path& path) = 0;
  /// When it succeeds, names made, changed and removed in the folder stay so after a power cut.
  virtual Result<void> sync_folder(const std::filesystem::path& path) = 0;
  /// Error: another process (or another lock of this one) holds it.
  virtual Result<std::unique_ptr<FolderLock>> lock(const std::filesystem::path& folder) = 0;

 protected:
  virtual Result<std::string> read_up_to(const std::filesystem::path& path,
                                         std::uint64_t limit) const = 0;
};

/// What read() says of a file that is longer than it may be.
Error too_large(const std::filesystem::path& path, std::uint64_t limit);

/// Makes the folder and those above it that are missing; their names survive a power cut.
Result<void> make_folders(FileSystem& files, const std::filesystem::path& path);

/// Removes a folder and all that is in it; links are removed, not followed.
Result<void> remove_tree(FileSystem& files, const std::filesystem::path& folder);

/// The disk. One object for the whole process, stateless.
FileSystem& posix_file_system();

/// Sees the bytes of a file as they are read back.
using ReadBack = std::function<Result<void>(std::string_view)>;

/// Writes a whole file so that after a power cut there is the old one or the new one, complete:
/// write under a temporary name, sync, read back when there is a `check`, rename, sync the folder.
Result<void> replace_file(FileSystem& files, const std::filesystem::path& path,
                          std::string_view bytes, const ReadBack& check = {});

/// What replace_file() appends to a name while it writes.
inline constexpr std::string_view kPartSuffix = ".part";

/// True when the folder holds this name.
Result<bool> contains(const FileSystem& files, const std::filesystem::path& folder,
                      std::string_view name);

}  // namespace imunoise::recording
