#pragma once

#include <spawn.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/support/result.h"

namespace imunoise::process {

/// How a child begins: nothing to read, no signal blocked or ignored, somewhere to print, and no
/// file of ours open: libraries do not always open theirs with O_CLOEXEC, and a child that
/// outlives us would hold ports and locks.
class Spawning {
 public:
  Spawning();
  ~Spawning();
  Spawning(const Spawning&) = delete;
  Spawning& operator=(const Spawning&) = delete;

  /// Standard input comes from an open descriptor.
  void read_from(int descriptor);
  /// Standard output and errors are appended to a file,
  void print_to(const std::filesystem::path& log);
  /// or go to an open descriptor, or to one each.
  void print_to(int descriptor) { print_to(descriptor, descriptor); }
  void print_to(int output, int errors);
  /// Starts `words[0]`, found along PATH, with the others as arguments. Error: it cannot be run.
  Result<pid_t> start(const std::vector<std::string>& words);

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

}  // namespace imunoise::process
