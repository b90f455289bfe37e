// imunoised hears signals, reads its files again, and leaves calendars to their timers.

#include "tests/daemon/imunoised_process.h"

namespace imunoise::app {
namespace {

using namespace std::chrono_literals;

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
