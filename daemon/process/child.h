#pragma once

// A program as a child process.

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/support/result.h"

namespace imunoise::process {

/// Runs beside this process; killed and awaited when destroyed before it ended.
class Child {
 public:
  /// Starts `words[0]`, found along PATH, with the others as arguments; what it prints is appended
  /// to `log`. Error: the program or the log's folder is not there.
  static Result<Child> start(const std::vector<std::string>& words,
                             const std::filesystem::path& log);

  Child(Child&& other) noexcept : pid_(std::exchange(other.pid_, 0)), signal_(other.signal_) {}
  Child& operator=(Child&&) = delete;
  ~Child();

  /// True once it ended, by itself or by a signal.
  bool ended();
  /// The signal that ended it; nothing when it ended by itself, or did not end yet.
  std::optional<int> signal() const { return signal_; }

 private:
  explicit Child(pid_t pid) : pid_(pid) {}
  pid_t pid_ = 0;  ///< 0: none to wait for
  std::optional<int> signal_;
};

/// What a program printed, standard output and errors together, and its exit status. Blocks until
/// it ended.
struct Said {
  int status = 0;
  std::string text;
};
/// Error: the program is not there.
Result<Said> ask(const std::vector<std::string>& words);

}  // namespace imunoise::process
