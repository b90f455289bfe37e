#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <chrono>
#include <thread>

#include "drivers/plugin/device.h"
#include "drivers/text/source/descriptor.h"
#include "drivers/text/source/source.h"

namespace imunoise::text {
namespace {

using namespace std::chrono_literals;

struct Pipe {
  Descriptor out;
  Descriptor in;
};

Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "pipe");
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

// A shell with a process group of its own, so that what it starts ends with it.
pid_t spawn(const std::string& command, const Pipe& output, const Pipe& errors) {
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&files, output.in.number(), STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, errors.in.number(), STDERR_FILENO);
  posix_spawnattr_t how;
  ::posix_spawnattr_init(&how);
  sigset_t none;
  sigemptyset(&none);
  ::posix_spawnattr_setsigmask(&how, &none);
  ::posix_spawnattr_setpgroup(&how, 0);
  ::posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  std::string shell = "sh";
  std::string option = "-c";
  std::string text = command;
  const std::array<char*, 4> words = {shell.data(), option.data(), text.data(), nullptr};
  pid_t child = 0;
  const int error = ::posix_spawn(&child, "/bin/sh", &files, &how, words.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  ::posix_spawnattr_destroy(&how);
  if (error != 0) throw std::system_error(error, std::generic_category(), "/bin/sh");
  return child;
}

class CommandSource final : public Source {
 public:
  explicit CommandSource(const std::string& command) : command_(command) {
    Pipe output = make_pipe();
    Pipe errors = make_pipe();
    child_ = spawn(command, output, errors);
    output_ = std::move(output.out);
    errors_ = std::move(errors.out);
  }
  ~CommandSource() override {
    if (child_ > 0 && !ends_within(0ms)) {
      ::kill(-child_, SIGTERM);
      if (!ends_within(1s)) {
        ::kill(-child_, SIGKILL);
        ::waitpid(child_, nullptr, 0);
      }
    }
  }
  int descriptor() const override { return output_.number(); }
  std::optional<std::size_t> read(std::span<std::uint8_t> into) override {
    hear_errors();
    const auto got = output_.read(into);
    if (got) return got;
    const bool ended = ends_within(1s);
    hear_errors();
    if (ended && WIFEXITED(status_) && WEXITSTATUS(status_) == 0) return std::nullopt;
    throw plugin::DeviceError(IMUNOISE_DISCONNECTED,
                              fmt::format("{}: {}{}", command_, how(ended), last_words()));
  }

 private:
  std::string how(bool ended) const {
    if (!ended) return "it closed its output";
    if (WIFSIGNALED(status_)) return fmt::format("it ended by signal {}", WTERMSIG(status_));
    return fmt::format("it ended with status {}", WEXITSTATUS(status_));
  }
  // What it said last on its standard error.
  std::string last_words() const {
    const std::size_t end = said_.find_last_not_of("\r\n");
    if (end == std::string::npos) return {};
    const std::size_t begin = said_.find_last_of('\n', end);
    return ": " + said_.substr(begin == std::string::npos ? 0 : begin + 1,
                               end - (begin == std::string::npos ? 0 : begin + 1) + 1);
  }
  void hear_errors() {
    constexpr std::size_t kKept = 1000;
    std::array<std::uint8_t, 4096> some{};
    for (;;) {
      const auto got = errors_.read(some);
      if (!got || *got == 0) return;
      said_.append(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(*got));
      if (said_.size() > kKept) said_.erase(0, said_.size() - kKept);
    }
  }
  // Takes note of the end, which comes once.
  bool ends_within(std::chrono::milliseconds time) {
    const auto deadline = std::chrono::steady_clock::now() + time;
    while (child_ > 0) {
      const pid_t over = ::waitpid(child_, &status_, WNOHANG);
      if (over != 0) child_ = 0;
      if (over == 0 && std::chrono::steady_clock::now() >= deadline) return false;
      if (over == 0) std::this_thread::sleep_for(5ms);
    }
    return true;
  }

  std::string command_;
  Descriptor output_;
  Descriptor errors_;
  std::string said_;
  pid_t child_ = 0;  // 0: it ended
  int status_ = 0;
};

}  // namespace

SourcePlace command_source(const std::string& command) {
  return {command, false,
          [command](const plugin::Wait&) { return std::make_unique<CommandSource>(command); }};
}

}  // namespace imunoise::text
