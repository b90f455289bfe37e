#include "daemon/process/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fstream>

#include "core/support/descriptor.h"
#include "daemon/process/spawning.h"

namespace imunoise::process {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kLastWords = 2000;  // bytes that are kept of what it says
constexpr std::chrono::seconds kGrace{3};
constexpr int kLookEvery = 100;  // ms

// NOLINTNEXTLINE(concurrency-mt-unsafe): glibc's has no shared state for known errors.
std::string reason(int number) { return std::strerror(number); }

// All are requests: where they are refused it runs as we do.
void step_back(pid_t child) {
  setpriority(PRIO_PROCESS, static_cast<id_t>(child), 19);
  const sched_param none{};
  sched_setscheduler(child, SCHED_BATCH, &none);
  std::ofstream("/proc/" + std::to_string(child) + "/oom_score_adj") << 1000;
}

struct Pipe {
  Descriptor reading;
  Descriptor writing;
};

Result<Pipe> make_pipe() {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return fail("no pipe: " + reason(errno));
  return Pipe{Descriptor(ends[0]), Descriptor(ends[1])};
}

// A file in memory rather than a pipe: it takes any text at once, and a child that does not read
// it does no harm.
Result<Descriptor> file_of(std::string_view text) {
  Descriptor out(::memfd_create("imunoise", MFD_CLOEXEC));
  if (out.get() < 0) return fail("no file in memory: " + reason(errno));
  while (!text.empty()) {
    const ssize_t count = ::write(out.get(), text.data(), text.size());
    if (count < 0 && errno != EINTR) return fail("no file in memory: " + reason(errno));
    text.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  }
  ::lseek(out.get(), 0, SEEK_SET);
  return out;
}

// The time that a process spent on the processor, all its threads together.
class ProcessorTime {
 public:
  explicit ProcessorTime(pid_t process) { known_ = ::clock_getcpuclockid(process, &clock_) == 0; }
  // By so much as only work takes, since it last did: a thread that waits for a signal, and looks
  // about now and then, takes a hundredth of it in a second.
  bool grew() {
    constexpr std::chrono::milliseconds kWork{20};
    timespec time{};
    if (!known_ || ::clock_gettime(clock_, &time) != 0) return false;
    const auto used = std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
    if (used - used_ < kWork) return false;
    used_ = used;
    return true;
  }

 private:
  clockid_t clock_{};
  bool known_ = false;
  std::chrono::nanoseconds used_{0};
};

// Hears a child until it has closed its ends.
class Listener {
 public:
  explicit Listener(const Talk& talk) : talk_(talk) {}

  // Returns the last of what it said, lines aside.
  std::string listen(int lines, int rest, pid_t child, const Progress& progress) {
    std::array<pollfd, 2> pipes = {{{lines, POLLIN, 0}, {rest, POLLIN, 0}}};
    Clock::time_point asked = Clock::time_point::max();  // to end
    ProcessorTime processor(child);
    while (pipes[0].fd >= 0 || pipes[1].fd >= 0) {
      if (progress.stopped() && asked == Clock::time_point::max()) {
        asked = Clock::now();
        ::kill(child, SIGTERM);
      }
      if (asked != Clock::time_point::max() && Clock::now() - asked > kGrace) {
        ::kill(child, SIGKILL);
        break;
      }
      const bool said = ::poll(pipes.data(), pipes.size(), kLookEvery) > 0;
      if (talk_.works && (processor.grew() || said)) talk_.works();
      if (!said) continue;
      for (pollfd& pipe : pipes) {
        if (pipe.revents != 0 && !take(pipe.fd, &pipe == &pipes.front())) pipe.fd = -1;
      }
    }
    return std::move(said_);
  }

 private:
  // False at the end.
  bool take(int pipe, bool lines) {
    std::array<char, 65536> buffer;
    const ssize_t count = ::read(pipe, buffer.data(), buffer.size());
    if (count < 0) return errno == EINTR;
    const std::string_view bytes(buffer.data(), static_cast<std::size_t>(count));
    if (lines) {
      take_lines(bytes);
    } else {
      said_ += bytes;
      if (said_.size() > kLastWords) said_.erase(0, said_.size() - kLastWords);
    }
    return count > 0;
  }

  void take_lines(std::string_view bytes) {
    for (std::size_t end = 0; (end = bytes.find('\n')) != std::string_view::npos;) {
      line_ += bytes.substr(0, end);
      talk_.hear(line_);
      line_.clear();
      bytes.remove_prefix(end + 1);
    }
    line_ += bytes;
  }

  const Talk& talk_;
  std::string line_;
  std::string said_;
};

}  // namespace

Result<void> run_program(const std::vector<std::string>& command, const Progress& progress,
                         const Talk& talk) {
  auto input = file_of(talk.input);
  if (!input) return tl::make_unexpected(input.error());
  auto words = make_pipe();
  if (!words) return tl::make_unexpected(words.error());
  auto lines = make_pipe();
  if (!lines) return tl::make_unexpected(lines.error());
  Spawning spawning;
  spawning.read_from(input->get());
  spawning.print_to(talk.hear ? lines->writing.get() : words->writing.get(), words->writing.get());
  const auto child = spawning.start(command);
  if (!child) return tl::make_unexpected(child.error());
  words->writing = Descriptor();
  lines->writing = Descriptor();
  step_back(*child);
  std::string said =
      Listener(talk).listen(lines->reading.get(), words->reading.get(), *child, progress);
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
