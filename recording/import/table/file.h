#pragma once

// Bytes of a regular file, read where they are needed. Sizes claimed inside a file are checked
// against the file's own size before memory is asked for.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/support/result.h"

namespace imunoise::recording {

/// A regular file opened for reading. Movable; thread-safe to read.
class File {
 public:
  /// Error: no such file, no permission, a folder, not a regular file.
  static Result<File> open(const std::filesystem::path& path);

  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File();

  /// How messages call the file.
  const std::string& name() const { return name_; }
  /// Size in bytes when the file was opened.
  std::uint64_t size() const { return size_; }
  /// Reads up to out.size() bytes at `offset`; fewer only at the end of the file. Error: the
  /// disk's.
  Result<std::size_t> read_at(std::uint64_t offset, std::span<char> out) const;

 private:
  File(int descriptor, std::uint64_t size, std::string name)
      : descriptor_(descriptor), size_(size), name_(std::move(name)) {}

  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::string name_;
};

}  // namespace imunoise::recording
