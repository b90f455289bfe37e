#pragma once

// The bytes of a device's wire, beside its samples.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "recording/store/file_system.h"

namespace imunoise::acquire {

/// Takes bytes from the moment when a device is opened, which is before there is a folder to write
/// into. Functions are thread-safe.
class WireFile {
 public:
  /// Keeps them in memory until open(), then writes them as they come. After an error it takes no
  /// more.
  void take(std::span<const std::uint8_t> bytes);
  /// From now on into this file, which is made anew.
  void open(recording::FileSystem& files, const std::filesystem::path& path);
  /// Syncs the file. Error: the disk's, from open() on.
  Result<void> close();

 private:
  void note(const Result<void>& done);

  std::mutex mutex_;
  std::string early_;  // bytes, before open()
  std::unique_ptr<recording::WritableFile> file_;
  std::optional<Error> trouble_;
};

}  // namespace imunoise::acquire
