// `imunoise replay` and `record --wire` as a user runs them.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace imunoise {
namespace {

using nlohmann::json;
using testing::Outcome;

class Replaying : public testing::Program {
 protected:
  json json_of(const std::string& arguments) const {
    const Outcome done = run(arguments + " --json");
    EXPECT_EQ(done.status, 0) << arguments << ": " << done.errors;
    return done.out.empty() ? json() : json::parse(done.out);
  }
  // Two seconds of an emulated sensor, and its wire.
  json record(const std::string& device, const std::string& more = "--wire") const {
    return json_of("record monday --device 'emulated device=" + device + " seed=4' --duration 2 " +
                   more);
  }
  static std::string stored(const json& report, const std::string& stream) {
    for (const json& one : report["streams"]) {
      if (one["stream"] == stream) return one["stored"];
    }
    return "none";
  }
  // As many as before, and perhaps a few that came too late to be stored then.
  static void expect_replayed(const json& after, const json& before, const std::string& stream) {
    const int count = std::stoi(stored(before, stream));
    EXPECT_GT(count, 100);
    EXPECT_GE(std::stoi(stored(after, stream)), count);
    EXPECT_LE(std::stoi(stored(after, stream)), count + 50);
  }
  json moments(const std::string& folder, const std::string& channel) const {
    return json_of("wv " + folder + " --channel " + channel)["variance"];
  }
};

TEST_F(Replaying, ARecordingComesBackWithEveryStreamAndSample) {
  const json before = record("adis16405", "");
  const json after = json_of("replay monday --into copy");
  for (const char* const stream : {"imu", "magnetometer", "housekeeping"}) {
    EXPECT_EQ(stored(after, stream), stored(before, stream)) << stream;
  }
  EXPECT_EQ(moments("copy", "replay/imu/gyro_x"), moments("monday", "emulated/imu/gyro_x"));
  EXPECT_TRUE(json_of("verify copy")["sound"].get<bool>());
}

TEST_F(Replaying, AWireGivesTheSamplesBesideIt) {
  const json before = record("adis16405");
  EXPECT_TRUE(json_of("verify monday")["sound"].get<bool>()) << "the wire's file harms nobody";
  const json after = json_of(
      "replay monday/replicate-1/emulated.wire --format adis16405 --rate 102.4 --into again");
  expect_replayed(after, before, "imu");
}

TEST_F(Replaying, AWireIsACaptureForDecode) {
  const json before = record("xsens");
  const Outcome decoded = run("decode --format xbus monday/replicate-1/emulated.wire");
  EXPECT_EQ(decoded.status, 0) << decoded.errors;
  EXPECT_NE(decoded.out.find("gyro_x"), std::string::npos);
  const json after = json_of("replay monday/replicate-1/emulated.wire --format xbus --into again");
  expect_replayed(after, before, "imu");
}

TEST_F(Replaying, ACanImusCounterIsRecordedUnderAnotherName) {
  const json before = record("can");
  EXPECT_NE(stored(before, "Counter"), "none");
  const json after = json_of(
      "replay monday/replicate-1/emulated.wire --format candump --preset mti600 --into again");
  expect_replayed(after, before, "RateOfTurn");
}

TEST_F(Replaying, FilesOfOthersAndTheirPace) {
  ASSERT_EQ(run("simulate --model 'WN(sigma2=1)' --rate 100 --samples 300 --out run.h5").status, 0);
  EXPECT_EQ(stored(json_of("replay run.h5 --into copy"), "samples"), "300");
  const json part = json_of("replay run.h5 --into slow --speed 1 --duration 0.5");
  EXPECT_LT(std::stoi(stored(part, "samples")), 300);
}

TEST_F(Replaying, SaysWhatItCannotDo) {
  const auto expect = [&](const std::string& arguments, const std::string& words) {
    const Outcome done = run("replay " + arguments);
    EXPECT_NE(done.status, 0) << arguments;
    EXPECT_NE(done.errors.find(words), std::string::npos) << arguments << ": " << done.errors;
  };
  ASSERT_EQ(run("simulate --model 'WN(sigma2=1)' --rate 100 --samples 300 --out run.h5").status, 0);
  expect("absent --into copy", "absent");
  expect("run.h5", "--into");
  expect("run.h5 --into copy --device imu0", "device: only recordings");
  expect("run.h5 --into copy --format morse", "morse");
  expect("run.h5 --into copy --format candump", "preset=NAME");
  expect("run.h5 --into copy --format xbus", "no Xbus frame");
}

}  // namespace
}  // namespace imunoise
