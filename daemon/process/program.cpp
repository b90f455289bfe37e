#include "daemon/process/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>

#include "daemon/process/spawning.h"

namespace imunoise::process {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kLastWords = 2000;  // bytes that are kept of what it says
constexpr std::chrono::seconds kGrace{3};
constexpr int kLookEvery = 100;  // ms

// NOLINTNEXTLINE(concurrency-mt-unsafe): glibc's has no shared state for known errors.
std::string reason(int number) { return std::strerror(number); }

// Both are requests: where they are refused it runs as we do.
void step_back(pid_t child) {
  setpriority(PRIO_PROCESS, static_cast<id_t>(child), 19);
  std::ofstream("/proc/" + std::to_string(child) + "/oom_score_adj") << 1000;
}

// Listens until the child has closed its end. Returns the last of what it said.
std::string listen(int pipe, pid_t child, const Progress& progress) {
  std::string said;
  Clock::time_point asked = Clock::time_point::max();  // to end
  for (;;) {
    if (progress.stopped() && asked == Clock::time_point::max()) {
      asked = Clock::now();
      ::kill(child, SIGTERM);
    }
    if (asked != Clock::time_point::max() && Clock::now() - asked > kGrace) {
      ::kill(child, SIGKILL);
      return said;
    }
    pollfd wait{pipe, POLLIN, 0};
    if (::poll(&wait, 1, kLookEvery) <= 0) continue;
    char buffer[4096];
    const ssize_t count = ::read(pipe, buffer, sizeof buffer);
    if (count == 0 || (count < 0 && errno != EINTR)) return said;
    if (count > 0) said.append(buffer, static_cast<std::size_t>(count));
    if (said.size() > kLastWords) said.erase(0, said.size() - kLastWords);
  }
}

}  // namespace

Result<void> run_program(const std::vector<std::string>& command, const Progress& progress) {
  int pipe[2];
  if (::pipe2(pipe, O_CLOEXEC) != 0) return fail("no pipe: " + reason(errno));
  Spawning spawning;
  spawning.print_to(pipe[1]);
  const auto child = spawning.start(command);
  ::close(pipe[1]);
  std::string said;
  if (child) {
    step_back(*child);
    said = listen(pipe[0], *child, progress);
  }
  ::close(pipe[0]);
  if (!child) return tl::make_unexpected(child.error());
  int status = 0;
  while (::waitpid(*child, &status, 0) < 0 && errno == EINTR) {
  }
  if (progress.stopped()) return fail("stopped");
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  while (!said.empty() && said.back() == '\n') said.pop_back();
  return fail(fmt::format("{}: {}: {}", command.front(),
                          WIFSIGNALED(status) ? fmt::format("ended by signal {}", WTERMSIG(status))
                                              : fmt::format("exit status {}", WEXITSTATUS(status)),
                          said));
}

}  // namespace imunoise::process
