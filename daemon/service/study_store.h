#pragma once

// The studies of the service: a folder with a file each, as `imunoise study` reads and writes them.

#include <filesystem>
#include <memory>
#include <string>

#include "daemon/service/answer.h"
#include "imunoise/v1/service.pb.h"
#include "recording/store/file_system.h"

namespace imunoise::service {

/// Letters, digits, '_', '-' and '.', the first no '.', at most 64. Error: 400.
Answer<void> check_study_name(const std::string& name);

/// Thread-safe, but for two threads that change one study.
class StudyStore {
 public:
  explicit StudyStore(std::filesystem::path folder);

  Answer<v1::StudyList> list() const;
  /// Error: 400 for a name that is none, 404, 500 where the file is damaged.
  Answer<v1::Study> read(const std::string& name) const;
  bool contains(const std::string& name) const;
  /// Replaces the file; after a power cut there is the old or the new one. Makes the folder.
  Result<void> write(const std::string& name, const v1::Study& study) const;

 private:
  std::filesystem::path file_of(const std::string& name) const;

  std::filesystem::path folder_;
  std::unique_ptr<recording::FileSystem> files_;
};

}  // namespace imunoise::service
