#include "recording/hdf5/limited_child.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <hdf5.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace imunoise::recording {
namespace {

constexpr int kFailed = 3;         // exit status of a child that an exception ended
constexpr int kPatience_ms = 100;  // between two questions whether to stop
constexpr int kLine = 3;           // the child's end of the line
constexpr int kLooks = 50;         // at a child that should end by itself, 10 ms apart

void set_soft_limit(__rlimit_resource resource, std::uint64_t value) {
  rlimit limit = {};
  if (::getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(value, limit.rlim_max);
  ::setrlimit(resource, &limit);
}

// The terminal's signals are for the parent, which ends the child when it wants; what kills by
// itself kills at once, whatever handler the program has, and leaves no core.
void prepare_signals() {
  for (const int ignored : {SIGINT, SIGQUIT, SIGHUP, SIGTERM, SIGPIPE, SIGALRM, SIGUSR1, SIGUSR2})
    ::signal(ignored, SIG_IGN);
  for (const int deadly : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGXCPU, SIGSYS})
    ::signal(deadly, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::pthread_sigmask(SIG_SETMASK, &none, nullptr);
}

// Keeps this file alone, as kLine. Whatever a library says when it crashes, the parent says it
// better. closefrom() ends the child where it can close nothing.
void close_all_but(int descriptor) {
  if (descriptor != kLine) ::dup2(descriptor, kLine);
  ::closefrom(kLine + 1);
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, standard);
  ::close(nowhere);
}

[[noreturn]] void run_child(const std::function<void(const Line&)>& work, int descriptor,
                            pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kFailed);  // it ended before the line above
  prepare_signals();
  close_all_but(descriptor);
  set_soft_limit(RLIMIT_CORE, 0);
  set_soft_limit(RLIMIT_FSIZE, 0);
  try {
    const Line line(kLine);
    work(line);
  } catch (...) {
    ::_exit(kFailed);
  }
  ::_exit(0);
}

struct Fork {
  const std::function<void(const Line&)>& work;
  int descriptor;
  pid_t pid = -1;
  int error = 0;
};

// Called by HDF5, which holds its lock meanwhile: no other thread is inside the library, and the
// child's only thread owns the lock.
herr_t fork_inside(hid_t, const char*, void* data) {
  Fork& made = *static_cast<Fork*>(data);
  sigset_t all;
  sigset_t before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);  // no handler of the parent's runs in the child
  const pid_t parent = ::getpid();
  made.pid = ::fork();
  if (made.pid == 0) run_child(made.work, made.descriptor, parent);
  made.error = errno;
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return 1;  // no further property
}

std::uint64_t memory_now() {
  const int descriptor = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  std::array<char, 128> text = {};
  const ssize_t got = descriptor < 0 ? -1 : ::read(descriptor, text.data(), text.size());
  if (descriptor >= 0) ::close(descriptor);
  std::uint64_t pages = 0;
  if (got > 0) std::from_chars(text.data(), text.data() + got, pages);
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace

Line::~Line() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool Line::send(std::span<const char> bytes) const {
  while (!bytes.empty()) {
    const ssize_t done = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
  return true;
}

bool Line::receive(std::span<char> bytes, const std::function<bool()>& stopped,
                   std::chrono::nanoseconds patience) const {
  using Steady = std::chrono::steady_clock;
  Steady::time_point heard = Steady::now();
  while (!bytes.empty()) {
    pollfd ready = {descriptor_, POLLIN, 0};
    if (stopped && stopped()) return false;
    if (::poll(&ready, 1, kPatience_ms) <= 0) {
      if (Steady::now() - heard >= patience) return false;
      continue;
    }
    heard = Steady::now();
    const ssize_t done = ::recv(descriptor_, bytes.data(), bytes.size(), 0);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
  return true;
}

Result<LimitedChild> LimitedChild::start(const std::function<void(const Line&)>& work) {
  const auto trouble = [](int error) {
    return fail(fmt::format("cannot start a process to read it: {}; try again",
                            std::generic_category().message(error)));
  };
  std::array<int, 2> ends = {};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return trouble(errno);
  Line ours(ends[0]);
  const Line theirs(ends[1]);
  Fork made{work, theirs.descriptor()};
  // Any class with a property will do: what counts is to be called from inside the library.
  const bool called = H5Piterate(H5P_FILE_ACCESS, nullptr, fork_inside, &made) >= 0;
  if (made.pid < 0 && made.error != 0) return trouble(made.error);
  if (made.pid < 0) {
    return fail(
        fmt::format("no process can be made to read it: HDF5 {} (H5Piterate); check the "
                    "installation of libhdf5",
                    called ? "knows no property of a file" : "reports an error"));
  }
  return LimitedChild(made.pid, std::move(ours));
}

LimitedChild::~LimitedChild() {
  if (pid_ >= 0) ::kill(pid_, SIGKILL);
  wait();
}

int LimitedChild::wait() {
  int status = 0;
  if (pid_ < 0) return status;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return status;
}

bool LimitedChild::ends_soon(int& status) {
  constexpr timespec kPause = {0, 10'000'000};
  for (int look = 0; look < kLooks; ++look) {
    const pid_t ended = ::waitpid(pid_, &status, WNOHANG);
    if (ended == pid_) {
      pid_ = -1;
      return true;
    }
    if (ended < 0 && errno != EINTR) return false;
    ::nanosleep(&kPause, nullptr);
  }
  return false;
}

std::string LimitedChild::cause_of_death() {
  ::shutdown(line_.descriptor(), SHUT_RDWR);  // one that still lives waits for nothing more
  int status = 0;
  if (!ends_soon(status)) {
    ::kill(pid_, SIGKILL);
    wait();
    return "it did nothing for too long";
  }
  if (!WIFSIGNALED(status)) return "it ended early";
  const int signal = WTERMSIG(status);
  if (signal == SIGXCPU) return "it exceeded its computing time";
  return fmt::format("it crashed, signal {}", signal);
}

void limit_memory(std::uint64_t bytes) {
  const std::uint64_t now = memory_now();
  if (now > 0) set_soft_limit(RLIMIT_AS, now + bytes);  // unknown without /proc
}

void limit_computing(std::uint64_t seconds) {
  rusage used = {};
  ::getrusage(RUSAGE_SELF, &used);
  const auto so_far = static_cast<std::uint64_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec);
  set_soft_limit(RLIMIT_CPU, so_far + seconds + 1);
}

}  // namespace imunoise::recording
