// `imunoise devices`, `campaigns`, `status`, `start`, `stop` against a real imunoised, by its
// socket and by TCP.

#include <signal.h>
#include <sys/stat.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/client/event_reader.h"
#include "tests/cli/program.h"

namespace imunoise {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::Outcome;

class Daemon : public testing::Program {
 protected:
  ~Daemon() override {
    if (daemon_ > 0) end(SIGKILL);
  }

  // A campaign of an emulated sensor.
  void campaign(const std::string& name, const std::string& keys) const {
    std::ofstream(folder_ / (name + ".toml"))
        << "name = \"" << name << "\"\nfolder = \"data/" << name << "\"\n"
        << keys
        << "\n[[device]]\nname = \"imu0\"\ndriver = \"emulated\"\noptions.device = \"adis16405\"\n"
           "options.seed = 7\n";
  }
  void start_daemon(const std::string& options = "--socket api.sock") {
    const std::string command =
        "cd '" + folder_.string() + "' && exec '" IMUNOISED "' " + options + " . > log 2>&1";
    daemon_ = ::fork();
    if (daemon_ == 0) {
      ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      ::_exit(127);
    }
    ASSERT_TRUE(comes("answers on")) << read("log");
  }
  bool comes(const std::string& words) const {
    const auto deadline = std::chrono::steady_clock::now() + 20s;
    while (read("log").find(words) == std::string::npos) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(10ms);
    }
    return true;
  }
  // Its exit status, or 1000 and the signal.
  int end(int signal) {
    ::kill(daemon_, signal);
    int status = 0;
    ::waitpid(daemon_, &status, 0);
    daemon_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  Outcome ask(const std::string& arguments) const { return run(arguments + " --socket api.sock"); }
  json state(const std::string& name) const {
    const json all = json::parse(ask("status --json").out);
    for (const json& one : all["campaigns"]) {
      if (one["campaign"]["name"] == name) return one;
    }
    return {};
  }
  bool comes_to(const std::string& name, bool running) const {
    for (int i = 0; i < 1000 && state(name)["running"] != running; ++i)
      std::this_thread::sleep_for(10ms);
    return state(name)["running"] == running;
  }

  pid_t daemon_ = 0;
};

TEST_F(Daemon, TellsWhatItDoesAndIsStoppedOnPurposeOnly) {
  campaign("array", "length = \"10 min\"\nreplicates = 2");
  start_daemon();
  ASSERT_TRUE(comes("records replicate 1 of 2"));
  EXPECT_EQ(ask("devices").out, "array imu0: emulated device=adis16405 seed=7, being recorded\n");
  EXPECT_NE(
      ask("campaigns").out.find("array: 2 replicates of 10 min, once; imu0; into data/array; runs"),
      std::string::npos)
      << ask("campaigns").out;
  EXPECT_NE(ask("status").out.find("array: records replicate 1 of 2"), std::string::npos);
  EXPECT_NE(ask("status").out.find("left)"), std::string::npos) << ask("status").out;
  const std::string outlook = "  array imu0: averaging times up to";  // once enough samples came
  for (int i = 0; i < 300 && ask("status").out.find(outlook) == std::string::npos; ++i)
    std::this_thread::sleep_for(100ms);
  EXPECT_NE(ask("status").out.find(outlook), std::string::npos) << ask("status").out;
  const std::string recording = state("array")["recording"];
  const std::string live = ask("live").out;
  for (const std::string word :
       {"array imu0", "Replicate 1 of", "gyro_x", "rad/s", "stored", "gaps"})
    EXPECT_NE(live.find(word), std::string::npos) << word << " in\n" << live;
  EXPECT_EQ(json::parse(ask("live --json").out)["replicates"][0]["campaign"], "array");

  const std::string path = " --recording data/array/" + recording;
  for (const std::string& wrong :
       {std::string(), std::string(" --recording 2020-01-01T000000Z"), path}) {
    const Outcome refused = ask("stop array" + wrong);
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.errors.find("replicate 1 of 2 of recording " + recording), std::string::npos)
        << refused.errors;
  }
  EXPECT_TRUE(state("array")["running"]);
  EXPECT_EQ(state("array")["status"]["phase"], "recording");

  EXPECT_EQ(ask("stop array --recording " + recording).status, 0);
  ASSERT_TRUE(comes_to("array", false));
  EXPECT_NE(ask("stop array").errors.find("is not running"), std::string::npos);
  EXPECT_NE(ask("recordings").out.find("imu0"), std::string::npos) << ask("recordings").errors;
  EXPECT_EQ(ask("calibrations").status, 0);
  EXPECT_NE(ask("history --device imu0").errors.find("imunoise calibrate"), std::string::npos);

  EXPECT_EQ(ask("start array").status, 0);
  ASSERT_TRUE(comes("as replicate-2 on disk")) << read("log");
  EXPECT_NE(ask("start array").errors.find("is already running"), std::string::npos);
  EXPECT_EQ(end(SIGTERM), 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "api.sock"));
}

TEST_F(Daemon, IsFollowedUntilNoCampaignRuns) {
  campaign("one", "length = \"2 s\"\nreplicates = 2");
  campaign("two", "length = \"1 s\"");
  start_daemon();
  const Outcome followed = ask("status --follow");
  EXPECT_EQ(followed.status, 0) << followed.errors;
  for (const char* const words :
       {"one: records replicate 2 of 2", "one: is finished", "two: is finished"})
    EXPECT_NE(followed.out.find(words), std::string::npos) << words << "\n" << followed.out;
  EXPECT_NE(followed.errors.find(" %, "), std::string::npos) << followed.errors;
  EXPECT_NE(followed.errors.find(" left"), std::string::npos);
  EXPECT_EQ(ask("start two --once").status, 0) << "it stays, and records again when it is asked";
  EXPECT_TRUE(comes_to("two", false));
  EXPECT_EQ(json::parse(ask("recordings --json").out)["recordings"].size(), 3U);
  EXPECT_EQ(end(SIGINT), 0);
}

TEST_F(Daemon, ComesByTcpWithAToken) {
  campaign("array", "length = \"10 min\"");
  const std::string viewer(32, 'v');
  std::ofstream(folder_ / "tokens") << "viewer " << viewer << "\n";
  ::chmod((folder_ / "tokens").c_str(), 0600);
  std::ofstream(folder_ / "mine") << viewer << "\n";
  start_daemon("--listen 127.0.0.1:0 --tokens tokens");
  const std::string log = read("log");
  const std::size_t at = log.find("port ");
  const std::string url =
      " --url http://127.0.0.1:" + log.substr(at + 5, log.find('\n', at) - at - 5);
  EXPECT_NE(run("status" + url).errors.find("missing or unknown token"), std::string::npos);
  EXPECT_EQ(run("status --token-file mine" + url).status, 0)
      << run("status --token-file mine" + url).errors;
  EXPECT_NE(run("stop array --token-file mine" + url).errors.find("operator"), std::string::npos);
  EXPECT_EQ(end(SIGTERM), 0);
}

TEST_F(Daemon, TroubleIsTold) {
  EXPECT_NE(ask("status").errors.find("api.sock: no answer"), std::string::npos);
  EXPECT_EQ(ask("status").status, 1);
  EXPECT_EQ(run("status --token-file absent").status, 2);
  EXPECT_EQ(run("recordings --bench north").status, 2) << "of a folder";
  campaign("array", "length = \"10 min\"");
  start_daemon();
  EXPECT_NE(ask("start nothing").errors.find("there is no campaign 'nothing'"), std::string::npos);
  EXPECT_NE(ask("start ../../x").errors.find("may not"), std::string::npos);
  const std::string second = "cd '" + folder_.string() +
                             "' && '" IMUNOISED
                             "' --once --socket api.sock array.toml 2>&1 & sleep 1; kill $!";
  std::FILE* const pipe = popen(second.c_str(), "r");
  std::string told(4096, '\0');
  told.resize(std::fread(told.data(), 1, told.size(), pipe));
  pclose(pipe);
  EXPECT_NE(told.find("API disabled"), std::string::npos) << told;
  EXPECT_EQ(ask("status").status, 0) << "the first one goes on answering";
}

TEST_F(Daemon, ACampaignOfATimerIsLeftToIt) {
  campaign("nightly", "length = \"1 s\"\nschedule = { calendar = \"Mon 02:00\" }");
  start_daemon();
  EXPECT_FALSE(state("nightly")["running"]);
  EXPECT_NE(ask("start nightly").errors.find("systemctl start imunoise-campaign@nightly"),
            std::string::npos);
}

TEST(EventReader, TakesEventsHoweverTheirBytesCome) {
  const std::string bytes =
      "event: campaign\ndata: {\"a\":\ndata: 1}\n\n: \n\nevent: job\ndata:x\n\ndata: "
      "nameless\n\nevent: none\n\n";
  for (std::size_t size = 1; size <= bytes.size(); ++size) {
    cli::EventReader reader;
    std::string told;
    for (std::size_t at = 0; at < bytes.size(); at += size) {
      EXPECT_TRUE(reader.push(std::string_view(bytes).substr(at, size),
                              [&](std::string_view name, const std::string& data) {
                                told += std::string(name) + "=" + data + ";";
                                return true;
                              }));
    }
    EXPECT_EQ(told, "campaign={\"a\":\n1};job=x;=nameless;") << size;
  }
}

TEST(EventReader, EndsWhenNoMoreIsWantedOrItIsTooMuch) {
  cli::EventReader reader;
  int taken = 0;
  EXPECT_FALSE(reader.push("data: a\n\ndata: b\n\n", [&](auto, auto&) { return ++taken < 1; }));
  EXPECT_EQ(taken, 1);
  cli::EventReader endless;
  const std::string much(std::size_t{1} << 20U, 'x');
  int pushed = 0;
  while (pushed < 100 && endless.push(much, [](auto, auto&) { return true; })) ++pushed;
  EXPECT_EQ(pushed, 16);
}

}  // namespace
}  // namespace imunoise
