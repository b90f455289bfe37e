#pragma once

// The studies of the service: a folder with a file each, as `imunoise study` reads and writes them.

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "daemon/service/api/answer.h"
#include "imunoise/v1/service.pb.h"
#include "recording/store/disk/watched_files.h"

namespace imunoise::service {

/// Letters, digits, '_', '-' and '.', the first no '.', at most 64. Error: 400.
Answer<void> check_study_name(const std::string& name);

/// Thread-safe.
class StudyStore {
 public:
  /// What hangs is among the `calls`.
  StudyStore(std::filesystem::path folder, recording::DiskCalls& calls);

  Answer<v1::StudyList> list() const;
  /// Error: 400 for a name that is none, 404, 500 where the file is damaged.
  Answer<v1::Study> read(const std::string& name) const;
  bool contains(const std::string& name) const;
  /// The folder for what can be worked out again; it may not be there.
  std::filesystem::path cache() const { return folder_ / ".imunoise"; }
  /// Makes the folder, too. After a power cut there is nothing or the whole study. Error: there is
  /// one of this name; the disk's.
  Result<void> create(const std::string& name, const v1::Study& study);
  /// After a power cut there is the old or the new one. Error: it was deleted since it was read;
  /// the disk's.
  Result<void> replace(const std::string& name, const v1::Study& study);
  /// For good, also where its file is damaged. Error: as read(), but for the damage.
  Answer<void> remove(const std::string& name);

 private:
  Result<void> write(const std::string& name, const v1::Study& study) const;
  Answer<void> check_known(const std::string& name) const;
  std::filesystem::path file_of(const std::string& name) const;

  std::filesystem::path folder_;
  recording::DiskCalls& calls_;
  std::unique_ptr<recording::FileSystem> confined_;
  recording::WatchedFiles files_;         // for reading: follows no link
  mutable recording::WatchedFiles disk_;  // for writing
  std::mutex changing_;
};

}  // namespace imunoise::service
