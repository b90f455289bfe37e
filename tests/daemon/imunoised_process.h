#pragma once

// imunoised as systemd or a person runs it: a child process.

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <iterator>
#include <mutex>
#include <optional>
#include <thread>

#include "daemon/acquire/campaign/recordings.h"
#include "recording/store/manifest/manifest.h"
#include "recording/store/verify/verify.h"
#include "tests/daemon/whims.h"

namespace imunoise::app {

// systemd's end of the notification socket.
class NotifySocket {
 public:
  explicit NotifySocket(const std::filesystem::path& path)
      : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.string().copy(address.sun_path, sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(socket_, static_cast<sockaddr*>(static_cast<void*>(&address)), sizeof address),
              0);
  }
  ~NotifySocket() { ::close(socket_); }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  // Fetches what has come.
  void listen() {
    const std::lock_guard lock(mutex_);
    char buffer[4096];
    for (ssize_t n = 0; (n = ::recv(socket_, buffer, sizeof buffer, 0)) > 0;) {
      told_.append(buffer, static_cast<std::size_t>(n)) += "\n";
    }
  }
  // A line each.
  std::string told() const {
    const std::lock_guard lock(mutex_);
    return told_;
  }

 private:
  int socket_;
  mutable std::mutex mutex_;
  std::string told_;
};

class Imunoised : public testing::Whims {
 protected:
  ~Imunoised() override {
    if (child_) {
      ::kill(*child_, SIGKILL);
      ::waitpid(*child_, nullptr, 0);
    }
  }

  void campaign(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / (name + ".toml"))
        << "name = \"" << name << "\"\nfolder = \"" << name << "\"\n"
        << "calibration.enabled = false\n"
        << text;
  }
  // A table of the device, which is here.
  std::string device(const std::string& name) const {
    tell(name, "here");
    return "[[device]]\nname = \"" + name + "\"\ndriver = \"whims\"\noptions.file = \"" +
           word_of(name).string() + "\"\n";
  }

  // Standard error goes to the file "errors" unless it has a descriptor.
  void start(std::vector<std::string> arguments,
             const std::vector<std::pair<std::string, std::string>>& environment = {},
             std::optional<int> errors = std::nullopt) {
    arguments.insert(arguments.begin(), {"imunoised", "--driver-path", IMUNOISE_TEST_PLUGINS});
    std::vector<char*> texts;
    for (std::string& one : arguments) texts.push_back(one.data());
    texts.push_back(nullptr);
    child_ = ::fork();
    if (*child_ != 0) return;
    for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
    if (::chdir(folder_.c_str()) != 0 || std::freopen("out", "w", stdout) == nullptr ||
        (errors ? ::dup2(*errors, STDERR_FILENO) < 0
                : std::freopen("errors", "w", stderr) == nullptr)) {
      ::_exit(126);
    }
    ::execv(IMUNOISED, texts.data());
    ::_exit(127);
  }
  // The exit status, or nothing when it does not end in time.
  std::optional<int> wait(std::chrono::milliseconds patience = std::chrono::seconds(30)) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    int status = 0;
    while (::waitpid(*child_, &status, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() > deadline) return std::nullopt;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    child_.reset();
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  std::optional<int> run(const std::vector<std::string>& arguments) {
    start(arguments);
    return wait();
  }
  void signal(int number) const { ::kill(*child_, number); }
  bool comes(const std::string& words,
             std::chrono::milliseconds patience = std::chrono::seconds(20)) const {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (read("errors").find(words) == std::string::npos) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
  }
  std::string read(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  // How often the log says it.
  std::size_t count(const std::string& words) const {
    const std::string log = read("errors");
    std::size_t out = 0;
    for (std::size_t at = 0; (at = log.find(words, at)) != std::string::npos; ++at) ++out;
    return out;
  }
  // A replicate of the campaign is being recorded.
  bool records(const std::string& name) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!newest(name)) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
  }
  // The newest recording of a campaign.
  std::optional<acquire::FoundRecording> newest(const std::string& name) const {
    v1::Campaign campaign;
    campaign.set_name(name);
    campaign.set_folder((folder_ / name).string());
    return acquire::newest_recording(recording::posix_file_system(), campaign,
                                     acquire::SystemClock())
        .value();
  }
  void expect_sound(const std::filesystem::path& folder) const {
    const auto report = recording::verify_recording(recording::posix_file_system(), folder, false);
    ASSERT_TRUE(report.has_value()) << report.error().message;
    EXPECT_TRUE(report->sound()) << report->ShortDebugString();
  }

  std::optional<pid_t> child_;
};

}  // namespace imunoise::app
