// A child process that ends, fails, or has to be ended.

#include "daemon/process/program.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "core/support/descriptor.h"
#include "daemon/process/ignored_signals.h"

namespace imunoise::process {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

std::string error_of(const std::string& script) {
  const auto done = run_program({"/bin/sh", "-c", script}, {});
  return done ? "" : done.error().message;
}

TEST(Program, TellsHowItEnded) {
  EXPECT_TRUE(run_program({"/bin/true"}, {}));
  EXPECT_EQ(error_of("echo one; echo two >&2; exit 3"), "/bin/sh: exit status 3: one\ntwo");
  EXPECT_EQ(error_of("kill -SEGV $$"), "/bin/sh: ended by signal 11: ");
  const auto absent = run_program({"/no/such/program"}, {});
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().message, "/no/such/program: cannot be run: No such file or directory");
}

TEST(Program, InheritsNeitherFilesNorIgnoredSignals) {
  const Descriptor leaked(::open("/dev/null", O_RDONLY));  // as libraries do, without O_CLOEXEC
  EXPECT_EQ(error_of("test ! -e /proc/$$/fd/" + std::to_string(leaked.get())), "");
  const IgnoredSignals ignored;
  for (const char* const name : {"PIPE", "USR1", "USR2"}) {
    EXPECT_NE(error_of(std::string("kill -") + name + " $$").find("ended by signal"),
              std::string::npos)
        << name;
  }
}

TEST(Program, KeepsTheLastOfMuchThatIsSaid) {
  const std::string said = error_of("seq 1 100000; exit 1");
  EXPECT_LT(said.size(), 3000U);
  EXPECT_TRUE(said.ends_with("\n99999\n100000")) << said;
}

TEST(Program, WorksWhenItUsesTheProcessorOrSpeaks) {
  const auto worked = [](const std::string& script) {
    int times = 0;
    const Talk talk{.works = [&] { ++times; }};
    EXPECT_TRUE(run_program({"/bin/sh", "-c", script}, {}, talk));
    return times;
  };
  EXPECT_LE(worked("exec sleep 0.7"), 3) << "its beginning and its end";
  EXPECT_GE(worked("for i in 1 2 3 4 5; do sleep 0.1; echo $i; done"), 5);
  EXPECT_GE(worked("i=0; while [ $i -lt 300000 ]; do i=$((i+1)); done"), 3);
}

TEST(Program, StepsBack) {
  EXPECT_EQ(error_of("sleep 0.1; test $(ps -o ni= -p $$) -eq 19"), "");
  EXPECT_EQ(error_of("sleep 0.1; test $(ps -o cls= -p $$) = B"), "");
  EXPECT_EQ(error_of("sleep 0.1; test $(cat /proc/$$/oom_score_adj) -eq 1000"), "");
}

TEST(Program, IsToldMuchAndHeardLineByLine) {
  std::string input;
  for (int i = 0; i < 100000; ++i) input += std::to_string(i) + "\n";
  std::string heard;
  const Talk talk{input, [&](std::string_view line) { heard += std::string(line) + "\n"; }};
  EXPECT_TRUE(run_program({"/bin/cat"}, {}, talk));
  EXPECT_EQ(heard, input);
  const auto done = run_program({"/bin/sh", "-c", "echo a line; echo why >&2; exit 1"}, {}, talk);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, "/bin/sh: exit status 1: why");
  EXPECT_TRUE(heard.ends_with("\na line\n"));
  EXPECT_TRUE(run_program({"/bin/true"}, {}, talk)) << "what it does not read is no matter";
}

TEST(Program, StopsWhenItIsAsked) {
  for (const char* script : {"sleep 60", "trap '' TERM; while :; do sleep 0.1; done"}) {
    std::stop_source source;
    const auto begin = Clock::now();
    std::thread stopper([&] {
      std::this_thread::sleep_for(300ms);
      source.request_stop();
    });
    const auto done = run_program({"/bin/sh", "-c", script}, Progress({}, source.get_token()));
    stopper.join();
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message, "stopped");
    EXPECT_LT(Clock::now() - begin, 5s);
  }
}

}  // namespace
}  // namespace imunoise::process
