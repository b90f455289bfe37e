#include "daemon/process/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "daemon/process/spawning.h"

namespace imunoise::process {
namespace {

// The status as a shell tells it: of its exit, or 128 + the signal.
int wait_for(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

std::string read_all(int descriptor) {
  std::string out;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return out;
    out.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace

Result<Child> Child::start(const std::vector<std::string>& words,
                           const std::filesystem::path& log) {
  Spawning spawning;
  spawning.print_to(log);
  const auto pid = spawning.start(words);
  if (!pid) return tl::unexpected(pid.error());
  return Child(*pid);
}

Child::~Child() {
  if (pid_ == 0) return;
  ::kill(pid_, SIGTERM);
  wait_for(pid_);
}

bool Child::ended() {
  if (pid_ == 0) return true;
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return false;
  pid_ = 0;
  if (WIFSIGNALED(status)) signal_ = WTERMSIG(status);
  return true;
}

Result<Said> ask(const std::vector<std::string>& words) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0)
    return fail(fmt::format("{}: no pipe: {}", words.front(), std::strerror(errno)));
  Spawning spawning;
  spawning.print_to(pipe[1]);
  const auto pid = spawning.start(words);
  ::close(pipe[1]);
  Said out;
  if (pid) {
    out.text = read_all(pipe[0]);
    out.status = wait_for(*pid);
  }
  ::close(pipe[0]);
  if (!pid) return tl::unexpected(pid.error());
  return out;
}

}  // namespace imunoise::process
