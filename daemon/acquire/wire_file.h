#pragma once

// The bytes of a device's wire, beside its samples.

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "recording/store/disk/file_system.h"

namespace imunoise::acquire {

/// Takes bytes from the moment when a device is opened, which is before there is a folder to write
/// into. A thread of its own writes them: the reader of the device never waits for the disk.
/// Functions are thread-safe.
class WireFile {
 public:
  /// Bytes that may wait for the disk.
  static constexpr std::size_t kMostWaiting = std::size_t{8} << 20U;

  WireFile() = default;
  ~WireFile();
  WireFile(const WireFile&) = delete;
  WireFile& operator=(const WireFile&) = delete;

  /// Keeps them until they are written. Those that find no room are lost, and counted; after an
  /// error it takes no more.
  void take(std::span<const std::uint8_t> bytes);
  /// From now on into this file, which is made anew.
  void open(recording::FileSystem& files, const std::filesystem::path& path);
  /// Writes what waits, and syncs the file. Error: the disk's, from open() on; bytes were lost.
  Result<void> close();

 private:
  void run();
  void note(const Result<void>& done);

  std::filesystem::path path_;
  std::unique_ptr<recording::WritableFile> file_;  // used by the thread

  std::mutex mutex_;  // guards what follows
  std::condition_variable work_;
  std::string waiting_;  // bytes
  std::uint64_t lost_ = 0;
  std::optional<Error> trouble_;
  bool closing_ = false;

  std::thread thread_;
};

}  // namespace imunoise::acquire
