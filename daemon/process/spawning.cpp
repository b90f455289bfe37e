#include "daemon/process/spawning.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

#include "daemon/process/ignored_signals.h"

namespace imunoise::process {

Spawning::Spawning() {
  posix_spawn_file_actions_init(&actions_);
  posix_spawnattr_init(&attributes_);
  // This process may have blocked the signals that should end its children.
  sigset_t none{};
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes_, &none);
  sigset_t usual{};  // or ignored some, which a child would inherit
  sigemptyset(&usual);
  for (const int one : IgnoredSignals::kSignals) sigaddset(&usual, one);
  posix_spawnattr_setsigdefault(&attributes_, &usual);
  posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
}

Spawning::~Spawning() {
  posix_spawn_file_actions_destroy(&actions_);
  posix_spawnattr_destroy(&attributes_);
}

void Spawning::print_to(const std::filesystem::path& log) {
  posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_APPEND, 0644);
  posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
}

void Spawning::read_from(int descriptor) {
  posix_spawn_file_actions_adddup2(&actions_, descriptor, STDIN_FILENO);
}

void Spawning::print_to(int output, int errors) {
  posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions_, errors, STDERR_FILENO);
}

Result<pid_t> Spawning::start(const std::vector<std::string>& words) {
  posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1);
  std::vector<std::string> copies = words;
  std::vector<char*> pointers;
  for (std::string& word : copies) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t pid = 0;
  const int failed =
      posix_spawnp(&pid, words.front().c_str(), &actions_, &attributes_, pointers.data(), environ);
  if (failed == 0) return pid;
  // NOLINTNEXTLINE(concurrency-mt-unsafe): glibc's has no shared state for known errors.
  return fail(fmt::format("{}: cannot be run: {}", words.front(), std::strerror(failed)));
}

}  // namespace imunoise::process
