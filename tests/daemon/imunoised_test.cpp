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
#include <set>
#include <thread>

#include "daemon/acquire/recordings.h"
#include "recording/store/manifest.h"
#include "recording/store/verify.h"
#include "tests/daemon/whims.h"

namespace imunoise::app {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

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
  std::optional<int> wait(std::chrono::milliseconds patience = 30s) {
    const auto deadline = Clock::now() + patience;
    int status = 0;
    while (::waitpid(*child_, &status, WNOHANG) == 0) {
      if (Clock::now() > deadline) return std::nullopt;
      std::this_thread::sleep_for(5ms);
    }
    child_.reset();
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  std::optional<int> run(const std::vector<std::string>& arguments) {
    start(arguments);
    return wait();
  }
  void signal(int number) const { ::kill(*child_, number); }
  bool comes(const std::string& words, std::chrono::milliseconds patience = 20s) const {
    const auto deadline = Clock::now() + patience;
    while (read("errors").find(words) == std::string::npos) {
      if (Clock::now() > deadline) return false;
      std::this_thread::sleep_for(10ms);
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
    const auto deadline = Clock::now() + 20s;
    while (!newest(name)) {
      if (Clock::now() > deadline) return false;
      std::this_thread::sleep_for(10ms);
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

TEST_F(Imunoised, ChecksCampaignsAndSaysWhatIsWrongAndWhere) {
  campaign("good", "length = \"2 s\"\n" + device("a"));
  EXPECT_EQ(run({"--check-config", "good.toml"}), 0);
  EXPECT_NE(read("out").find("good.toml: no errors: good: 1 device, 1 replicate of 2 s, once"),
            std::string::npos)
      << read("out");
  campaign("bad", "lenght = \"2 s\"\n" + device("a"));
  EXPECT_EQ(run({"--check-config", "good.toml", "bad.toml", "absent.toml"}), 1);
  EXPECT_NE(read("out").find("bad.toml:4:1: lenght: unknown; did you mean 'length'?"),
            std::string::npos)
      << read("out");
  EXPECT_NE(read("out").find("bad.toml:1:1: length: is missing"), std::string::npos);
  EXPECT_NE(read("out").find("absent.toml: cannot be read"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "good")) << "it records nothing";
}

TEST_F(Imunoised, RefusesCampaignsThatMeetInOneFolder) {
  campaign("a", "length = \"2 s\"\n" + device("a"));
  std::ofstream(folder_ / "b.toml") << "name = \"a\"\nfolder = \"./a\"\nlength = \"2 s\"\n"
                                    << device("a");
  EXPECT_EQ(run({"--check-config", "a.toml", "b.toml"}), 1);
  EXPECT_NE(read("out").find("b.toml: the name 'a'"), std::string::npos) << read("out");
  EXPECT_NE(read("out").find("b.toml: the folder ./a"), std::string::npos);
}

TEST_F(Imunoised, WrongUsageIsTold) {
  EXPECT_EQ(run({}), 2);
  EXPECT_NE(read("errors").find("CONFIG"), std::string::npos);
  EXPECT_EQ(run({"--help"}), 0);
  std::filesystem::create_directory(folder_ / "empty");
  EXPECT_EQ(run({"empty"}), 1);
  EXPECT_NE(read("errors").find("contains no campaign"), std::string::npos);
}

TEST_F(Imunoised, RecordsCampaignsSideBySide) {
  campaign("one", "length = \"1 s\"\nreplicates = 2\n" + device("a"));
  campaign("two", "length = \"1 s\"\n" + device("b") + device("c"));
  EXPECT_EQ(run({"."}), 0) << read("errors");
  const auto one = newest("one");
  const auto two = newest("two");
  ASSERT_TRUE(one && two) << read("errors");
  EXPECT_EQ(one->state.notes.size(), 2U);
  EXPECT_EQ(two->state.notes.size(), 1U);
  for (const auto& note : one->state.notes) EXPECT_EQ(note.state(), v1::complete);
  expect_sound(one->folder);
  expect_sound(two->folder);
  EXPECT_EQ(run({"."}), 0);
  EXPECT_EQ(newest("one")->folder, one->folder) << "what is finished is not recorded again";
}

TEST_F(Imunoised, SigtermClosesWithinFiveSecondsAndARestartGoesOn) {
  campaign("bench", "length = \"3 s\"\nreplicates = 2\n" + device("a"));
  start({"bench.toml"});
  ASSERT_TRUE(comes("records replicate 2 of 2")) << read("errors");
  std::this_thread::sleep_for(500ms);
  const auto begin = Clock::now();
  signal(SIGTERM);
  EXPECT_EQ(wait(), 0);
  EXPECT_LT(Clock::now() - begin, 5s);
  auto found = newest("bench");
  ASSERT_EQ(found->state.notes.size(), 2U);
  EXPECT_EQ(found->state.notes[1].state(), v1::interrupted);
  EXPECT_EQ(found->state.notes[1].reason(), "stopped");
  expect_sound(found->folder);

  EXPECT_EQ(run({"bench.toml"}), 0);
  EXPECT_NE(read("errors").find("records replicate 2 of 2, as replicate-3 on disk"),
            std::string::npos)
      << read("errors");
  found = newest("bench");
  ASSERT_EQ(found->state.notes.size(), 3U);
  EXPECT_EQ(found->state.notes[2].state(), v1::complete);
  expect_sound(found->folder);
}

TEST_F(Imunoised, SigtermWaitsForNoDeviceThatIsBeingOpened) {
  campaign("bench", "length = \"3 s\"\n" + device("a"));
  tell("a", "deaf");
  start({"bench.toml"});
  ASSERT_TRUE(comes("records replicate 1 of 1")) << read("errors");
  std::this_thread::sleep_for(200ms);
  const auto begin = Clock::now();
  signal(SIGTERM);
  EXPECT_EQ(wait(), 0);
  EXPECT_LT(Clock::now() - begin, 5s);
}

TEST_F(Imunoised, KilledItGoesOnToo) {
  campaign("bench", "length = \"3 s\"\nreplicates = 2\n" + device("a"));
  start({"bench.toml"});
  ASSERT_TRUE(comes("records replicate 1 of 2"));
  std::this_thread::sleep_for(1s);
  signal(SIGKILL);
  EXPECT_EQ(wait(), 1000 + SIGKILL);
  EXPECT_EQ(run({"bench.toml"}), 0) << read("errors");
  const auto found = newest("bench");
  ASSERT_EQ(found->state.notes.size(), 3U);
  EXPECT_EQ(found->state.notes[0].state(), v1::interrupted);
  EXPECT_EQ(found->state.notes[2].state(), v1::complete);
  expect_sound(found->folder);
}

TEST_F(Imunoised, IsHeldUpWithoutADeviceAndEndsWhenAsked) {
  campaign("bench", "length = \"1 s\"\npatience = \"200 ms\"\n" + device("a"));
  tell("a", "absent");
  start({"bench.toml"});
  ASSERT_TRUE(comes("is blocked and will try again")) << read("errors");
  EXPECT_NE(read("errors").find("the device is absent"), std::string::npos);
  tell("a", "here");
  EXPECT_EQ(wait(), 0);
  EXPECT_EQ(newest("bench")->state.notes.size(), 1U);
}

TEST_F(Imunoised, RepeatsAReplicateThatWasDisturbed) {
  campaign("bench", "length = \"5 s\"\n[stillness]\nrepeat_disturbed = true\n" + device("a") +
                        "options.speed = 20\n");
  start({"bench.toml"});
  ASSERT_TRUE(comes("records replicate 1 of 1"));
  std::this_thread::sleep_for(3s);
  tell("a", "knock");
  std::this_thread::sleep_for(100ms);
  tell("a", "here");
  ASSERT_TRUE(comes("as replicate-2 on disk")) << read("errors");
  EXPECT_NE(read("errors").find("the sensors moved 1 time"), std::string::npos) << read("errors");
  signal(SIGTERM);
  EXPECT_EQ(wait(), 0);
  const auto found = newest("bench");
  ASSERT_EQ(found->state.notes[0].disturbances_size(), 1);
  EXPECT_EQ(found->state.notes[0].disturbances(0).channel(), "gyro_x");
}

TEST_F(Imunoised, WaitsForTheScheduleAndTellsSystemd) {
  NotifySocket socket(folder_ / "notify");
  campaign("bench", "length = \"1 s\"\nschedule = { every = \"3 s\" }\n" + device("a"));
  start({"bench.toml"},
        {{"NOTIFY_SOCKET", (folder_ / "notify").string()}, {"WATCHDOG_USEC", "600000"}});
  // Somebody must listen: few notices wait in the socket.
  const std::jthread listener([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      socket.listen();
      std::this_thread::sleep_for(10ms);
    }
  });
  ASSERT_TRUE(comes("waits for the next recording")) << read("errors");
  const auto first = newest("bench")->folder;
  const auto deadline = Clock::now() + 20s;
  while (newest("bench")->folder == first && Clock::now() < deadline)
    std::this_thread::sleep_for(20ms);
  EXPECT_NE(newest("bench")->folder, first);
  signal(SIGINT);
  EXPECT_EQ(wait(), 0);
  socket.listen();
  const std::string told = socket.told();
  EXPECT_EQ(told.substr(0, 8), "READY=1\n") << told;
  EXPECT_NE(told.find("STATUS=bench: records replicate 1 of 1"), std::string::npos) << told;
  EXPECT_NE(told.find("WATCHDOG=1\n"), std::string::npos) << told;
  EXPECT_NE(told.find("STOPPING=1\n"), std::string::npos) << told;
}

TEST_F(Imunoised, AJournalThatIsNotItsOwnDoesNotSilenceIt) {
  campaign("bench", "length = \"1 s\"\n" + device("a"));
  start({"bench.toml"}, {{"JOURNAL_STREAM", "1:2"}});
  EXPECT_TRUE(comes("records replicate 1 of 1"));
  EXPECT_EQ(wait(), 0);
}

TEST_F(Imunoised, OtherSignalsAndALogThatIsClosedHurtNoRecording) {
  campaign("bench", "length = \"1 s\"\n" + device("a"));
  int pipe[2];
  ASSERT_EQ(::pipe2(pipe, O_CLOEXEC), 0);
  start({"bench.toml"}, {}, pipe[1]);
  ::close(pipe[0]);
  ::close(pipe[1]);
  ASSERT_TRUE(records("bench"));
  for (const int number : {SIGUSR1, SIGUSR2, SIGHUP, SIGPIPE}) signal(number);
  EXPECT_EQ(wait(), 0);
  const auto found = newest("bench");
  ASSERT_EQ(found->state.notes.size(), 1U);
  EXPECT_EQ(found->state.notes[0].state(), v1::complete);
  expect_sound(found->folder);
}

TEST_F(Imunoised, ABadFileStopsNoOtherCampaign) {
  NotifySocket socket(folder_ / "notify");
  campaign("good", "length = \"1 s\"\n" + device("a"));
  campaign("typo", "lenght = \"1 s\"\n" + device("b"));
  std::filesystem::create_directory(folder_ / "folder.toml");
  start({"."}, {{"NOTIFY_SOCKET", (folder_ / "notify").string()}});
  EXPECT_EQ(wait(), 1) << "not all that was asked for was done";
  ASSERT_TRUE(newest("good").has_value()) << read("errors");
  EXPECT_EQ(newest("good")->state.notes[0].state(), v1::complete);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "typo"));
  EXPECT_NE(read("errors").find("typo.toml:4:1: lenght: unknown"), std::string::npos);
  EXPECT_NE(read("errors").find("folder.toml: "), std::string::npos) << read("errors");
  socket.listen();
  EXPECT_NE(socket.told().find("rejected campaign files: ./folder.toml, ./typo.toml"),
            std::string::npos)
      << socket.told();
  EXPECT_EQ(run({"--check-config", "."}), 1) << "the check is strict";
  EXPECT_EQ(run({"typo.toml"}), 1) << "nothing is left to record";
}

TEST_F(Imunoised, SighupTakesUpWhatChanged) {
  const std::string waits = "length = \"1 s\"\nschedule = { every = \"1 h\" }\n";
  campaign("stays", "length = \"60 s\"\n" + device("a"));
  campaign("spoiled", "length = \"60 s\"\n" + device("b"));
  campaign("gone", waits + device("c"));
  campaign("changed", "length = \"2 s\"\nreplicates = 9\n" + device("d"));
  start({"."});
  for (const char* const name : {"stays", "spoiled", "gone", "changed"})
    ASSERT_TRUE(records(name)) << name << read("errors");
  ASSERT_TRUE(comes("gone: waits for the next recording")) << read("errors");
  ASSERT_TRUE(comes("changed: records replicate 1 of 9"));

  campaign("new", "length = \"1 s\"\n" + device("e"));
  std::filesystem::remove(folder_ / "gone.toml");
  campaign("spoiled", "lenght = \"1 s\"\n" + device("b"));
  campaign("changed", "length = \"2 s\"\nreplicates = 1\n" + device("d"));
  signal(SIGHUP);
  ASSERT_TRUE(comes("gone: ended")) << read("errors");
  ASSERT_TRUE(comes("new: is finished")) << read("errors");
  ASSERT_TRUE(comes("changed: is finished")) << read("errors");
  EXPECT_NE(read("errors").find("spoiled.toml:4:1: lenght"), std::string::npos);
  EXPECT_EQ(newest("new")->state.notes[0].state(), v1::complete);
  ASSERT_EQ(newest("changed")->state.notes.size(), 1U) << "the replicate was recorded to its end";
  EXPECT_EQ(newest("changed")->state.notes[0].state(), v1::complete);
  for (const char* const name : {"stays", "spoiled"}) {
    EXPECT_EQ(newest(name)->state.notes[0].state(), v1::open) << name;
    EXPECT_EQ(count(std::string(name) + ": records replicate 1 of 1"), 1U) << name;
  }
  EXPECT_EQ(count("gone: records"), 1U);
  signal(SIGTERM);
  EXPECT_EQ(wait(), 0);
}

TEST_F(Imunoised, PrintsTheTimerOfACalendar) {
  campaign("bench", "length = \"1 s\"\nschedule = { calendar = \"Mon 02:00\" }\n" + device("a"));
  EXPECT_EQ(run({"--print-timer", "bench.toml"}), 0);
  EXPECT_EQ(read("out"), "[Timer]\nOnCalendar=\nOnCalendar=Mon 02:00\n");
  campaign("other", "length = \"1 s\"\n" + device("a"));
  EXPECT_EQ(run({"--print-timer", "other.toml"}), 1);
  EXPECT_NE(read("errors").find("has no calendar"), std::string::npos);
}

TEST_F(Imunoised, ACalendarIsLeftToItsTimer) {
  campaign("bench", "length = \"1 s\"\nschedule = { calendar = \"Mon 02:00\" }\n" + device("a"));
  EXPECT_EQ(run({"bench.toml"}), 0);
  EXPECT_NE(read("errors").find("is left to its timer (Mon 02:00)"), std::string::npos);
  EXPECT_FALSE(newest("bench").has_value());
  EXPECT_EQ(run({"--once", "bench.toml"}), 0);
  const auto first = newest("bench");
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(run({"--once", "bench.toml"}), 0);
  EXPECT_NE(newest("bench")->folder, first->folder);
}

}  // namespace
}  // namespace imunoise::app
