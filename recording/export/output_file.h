#pragma once

// A file that appears under its name only when it is complete.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

#include "core/support/result.h"

namespace imunoise::recording {

/// A name beside the final one to write to; removed again unless commit() moves it into place.
class TemporaryName {
 public:
  explicit TemporaryName(const std::filesystem::path& target);
  ~TemporaryName();
  TemporaryName(const TemporaryName&) = delete;
  TemporaryName& operator=(const TemporaryName&) = delete;

  const std::filesystem::path& path() const { return temporary_; }
  /// Moves the file into place. Error: the file system's.
  Result<void> commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

/// A stream of bytes into a TemporaryName. Errors of the disk are told by finish().
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& target);

  void write(std::string_view bytes);
  /// Closes and moves into place. Error: disk full, no permission, ...
  Result<void> finish();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path target_;
  TemporaryName name_;
  std::unique_ptr<std::FILE, Closer> file_;
  int error_ = 0;
};

}  // namespace imunoise::recording
