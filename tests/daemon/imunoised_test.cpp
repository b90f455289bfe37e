// imunoised records campaigns: usage, schedules, ends and restarts.

#include "recording/store/manifest/manifest.h"
#include "recording/store/verify/verify.h"
#include "tests/daemon/imunoised_process.h"

namespace imunoise::app {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

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
  EXPECT_NE(read("out").find("b.toml: has the same name 'a'"), std::string::npos) << read("out");
  EXPECT_NE(read("out").find("b.toml: has the same folder ./a"), std::string::npos);
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

}  // namespace
}  // namespace imunoise::app
