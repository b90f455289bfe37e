// `imunoise record` as a user runs it, with the replay driver as the device.

#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace imunoise {
namespace {

using nlohmann::json;
using testing::Outcome;

class Record : public testing::Program {
 protected:
  void SetUp() override {
    const Outcome done = run(
        "simulate --model 'WN(sigma2=4e-6) + RW(gamma2=1e-12)' --rate 100 --samples 5000 --seed 5 "
        "--unit rad/s --channel gyro_x --out run.h5");
    ASSERT_EQ(done.status, 0) << done.errors;
  }
  // Records run.h5 at its own pace until samples are stored, then runs `script`; $child is the
  // recorder.
  Outcome recorded_until(const std::string& script) const {
    const std::string journal = (folder_ / "monday/replicate-1/replay/000001.journal").string();
    return run(
        "record monday --device 'replay file=run.h5 speed=1' --json & child=$!; for i in $(seq "
        "400); do test -s '" +
        journal + "' && break; sleep 0.05; done; " + script + "; wait $child");
  }
  json json_of(const std::string& arguments) const {
    const Outcome done = run(arguments + " --json");
    EXPECT_EQ(done.status, 0) << done.errors;
    return json::parse(done.out);
  }
};

TEST_F(Record, KeepsEverySampleOfEveryDevice) {
  const json report = json_of(
      "record monday --device 'replay file=run.h5 speed=0' --device \"replay 'file=run.h5' "
      "speed=0\"");
  ASSERT_EQ(report["streams"].size(), 2U);
  EXPECT_EQ(report["streams"][0]["device"], "replay");
  EXPECT_EQ(report["streams"][1]["device"], "replay-2");
  for (const json& stream : report["streams"]) {
    EXPECT_EQ(stream["replicate"], 1);
    EXPECT_EQ(stream["received"], "5000");
    EXPECT_EQ(stream["stored"], "5000");
    EXPECT_TRUE(stream["refused"].empty());
    EXPECT_EQ(stream["failure"], "");
  }
  EXPECT_EQ(run("verify monday").out.find("-0 ppm"), std::string::npos);
  const json verified = json_of("verify monday");
  EXPECT_TRUE(verified["sound"].get<bool>());
  EXPECT_EQ(verified["streams"][0]["stored"], "5000");
  EXPECT_EQ(verified["streams"][0]["gap_count"], "0");
}

TEST_F(Record, WhatWasRecordedHasTheVeryMomentsOfWhatWasReplayed) {
  json_of("record copy --device 'replay file=run.h5 speed=0'");
  EXPECT_EQ(json_of("wv copy")["variance"], json_of("wv run.h5")["variance"]);
}

TEST_F(Record, TakesQuotesAroundAValueThatHasBlanks) {
  const json report =
      json_of("record lines --device \"text command='seq 1 40' columns=x rate=100 listen=0.2\"");
  EXPECT_EQ(report["streams"][0]["stored"], "40");
  EXPECT_NE(run("record open --device \"text command='seq 1 40\"").errors.find("not closed"),
            std::string::npos);
}

TEST_F(Record, NumbersReplicates) {
  const std::string replay = "record monday --device 'replay file=run.h5 speed=0'";
  EXPECT_EQ(json_of(replay + " --replicates 2")["streams"][1]["replicate"], 2);
  EXPECT_EQ(json_of(replay)["streams"][0]["replicate"], 3) << "the next free one";
  EXPECT_EQ(json_of(replay + " --replicate 9")["streams"][0]["replicate"], 9);
  const Outcome again = run(replay + " --replicate 9");
  EXPECT_NE(again.status, 0);
  EXPECT_NE(again.errors.find("is recorded already"), std::string::npos) << again.errors;
  EXPECT_EQ(json_of("verify monday")["streams"].size(), 4U);
}

TEST_F(Record, EndsWhenItsTimeIsOver) {
  const json report = json_of("record monday --device 'replay file=run.h5 speed=1' --duration 0.5");
  const auto stored = std::stoi(report["streams"][0]["stored"].get<std::string>());
  EXPECT_GT(stored, 5);  // half a second at 100 Hz, on whatever machine
  EXPECT_LT(stored, 5000);
}

TEST_F(Record, ASignalEndsItInGoodOrder) {
  const Outcome done = recorded_until("kill -INT $child");
  EXPECT_EQ(done.status, 0) << done.errors;
  const json report = json::parse(done.out);
  EXPECT_EQ(report["streams"][0]["stored"], report["streams"][0]["received"]);
  EXPECT_TRUE(json_of("verify monday")["sound"].get<bool>());
}

TEST_F(Record, ALostTerminalEndsItInGoodOrder) {
  const Outcome done =
      recorded_until("kill -USR1 $child; kill -USR2 $child; sleep 0.2; kill -HUP $child");
  EXPECT_EQ(done.status, 0) << done.errors;
  const json report = json::parse(done.out);
  EXPECT_EQ(report["streams"][0]["stored"], report["streams"][0]["received"]);
  EXPECT_TRUE(json_of("verify monday")["sound"].get<bool>());
}

TEST_F(Record, NohupIsHeeded) {
  const auto before = std::signal(SIGHUP, SIG_IGN);  // NOLINT: as nohup does
  const Outcome done = run(
      "record monday --device 'replay file=run.h5 speed=1' --duration 0.8 --json & child=$!; sleep "
      "0.3; kill -HUP $child; wait $child");
  std::signal(SIGHUP, before);
  EXPECT_EQ(done.status, 0) << done.errors;
  const json report = json::parse(done.out);
  EXPECT_GT(std::stoi(report["streams"][0]["stored"].get<std::string>()), 50) << done.out;
}

// The driver tells what it found at opening, to a pipe whose reader has gone.
TEST_F(Record, AClosedPipeEndsNothing) {
  run("record monday --device 'emulated device=xsens seed=7' --duration 0.5 --json 2>&1 >report | "
      ":");
  const json report = json::parse(read("report"), nullptr, false);
  ASSERT_FALSE(report.is_discarded());
  EXPECT_EQ(report["streams"][0]["stored"], report["streams"][0]["received"]);
  EXPECT_TRUE(json_of("verify monday")["sound"].get<bool>());
}

TEST_F(Record, SaysWhatItCannotDo) {
  const auto expect = [&](const std::string& arguments, const std::string& words) {
    const Outcome done = run("record monday " + arguments);
    EXPECT_NE(done.status, 0) << arguments;
    EXPECT_NE(done.errors.find(words), std::string::npos) << arguments << ": " << done.errors;
  };
  expect("", "--device");
  expect("--device nothing", "nothing");
  expect("--device 'replay'", "file");
  expect("--device 'replay file=run.h5 colour=red'", "colour");
  expect("--device 'replay file'", "file");
  expect("--device 'replay file=absent.h5'", "absent.h5");
  expect("--device ' '", "expected a driver and its options");
  expect("--device 'replay file=run.h5 unit=\xb0/s'", "is not UTF-8");
  EXPECT_NE(run("record mond\xe4y --device 'replay file=run.h5'").errors.find("is not UTF-8"),
            std::string::npos);
}

}  // namespace
}  // namespace imunoise
