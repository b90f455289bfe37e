#pragma once

// A file that is packed as a whole (imu.csv.gz), unpacked beside the disk's other temporary files.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/support/result.h"

namespace imunoise::recording {

/// Removes what it unpacked when it goes. Movable.
class UnpackedFile {
 public:
  /// Nothing where the first bytes tell no packing (gzip, zstd, bzip2, lz4). Memory holds one block
  /// only; the temporary folder ($TMPDIR) needs room for the whole file. Error: the disk's, damaged
  /// bytes, no byte at all, `stopped`.
  static Result<std::optional<UnpackedFile>> of(const std::filesystem::path& packed,
                                                const std::function<bool()>& stopped);

  UnpackedFile(UnpackedFile&& other) noexcept;
  UnpackedFile& operator=(UnpackedFile&&) = delete;
  ~UnpackedFile();

  /// In a folder of its own, under its name without ".gz"; its sidecar beside it, if there is one.
  const std::filesystem::path& path() const { return path_; }
  /// The packed file ends too soon.
  bool truncated() const { return truncated_; }
  /// A message about path() as the user knows the file.
  std::string in_users_words(std::string message) const;

 private:
  UnpackedFile(std::filesystem::path packed, std::filesystem::path path)
      : packed_(std::move(packed)), path_(std::move(path)) {}
  Result<void> fill(const std::function<bool()>& stopped);

  std::filesystem::path packed_;
  std::filesystem::path path_;  // empty: moved from
  bool truncated_ = false;
};

}  // namespace imunoise::recording
