// `imunoise calibrate`, `recordings`, `calibrations` and `history` as a user runs them.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/cli/program.h"
#include "tests/recording/simulated_bench.h"
#include "tests/study/simulated_recording.h"

namespace imunoise {
namespace {

using nlohmann::json;
using testing::Outcome;

constexpr std::int64_t kWeek = 7 * 86'400'000'000'000;  // ns

class CatalogueCommands : public testing::Program {
 protected:
  // A recording of the device of serial 0042, in bench/week-N.
  void record_week(int week, const std::string& sigma2, std::uint32_t first = 1) const {
    testing::SimulatedRecording what;
    what.folder = folder_ / "bench" / ("week-" + std::to_string(week));
    what.channels = {{"gyro_x", "rad/s", "WN(sigma2=" + sigma2 + ")"}};
    what.started_ns += week * kWeek;
    what.seed = static_cast<std::uint64_t>(week);
    what.samples = 2048;
    what.first_replicate = first;
    what.replicates = 2;
    std::filesystem::create_directories(folder_ / "bench");
    testing::record(what);
  }
  std::string week(int number) const { return "bench/week-" + std::to_string(number); }
  void calibrate_week(int number) const {
    const Outcome done = run("calibrate " + week(number) + " --model WN --no-diagnose");
    ASSERT_EQ(done.status, 0) << done.errors;
  }
  json json_of(const std::string& arguments, int status = 0) const {
    const Outcome done = run(arguments + " --json");
    EXPECT_EQ(done.status, status) << done.errors;
    return json::parse(done.out);
  }
};

TEST_F(CatalogueCommands, ACalibrationSaysEverythingAboutARecording) {
  record_week(0, "4e-6");
  const Outcome done = run("calibrate bench/week-0 --model 'WN + RW' --report page.html");
  ASSERT_EQ(done.status, 0) << done.errors;
  for (const char* const words :
       {"angle random walk", "missing effect", "alike", "1 of 1 channels have a model"}) {
    EXPECT_NE(done.out.find(words), std::string::npos) << words << "\n" << done.out;
  }
  EXPECT_NE(read("page.html").find("angle random walk"), std::string::npos);
  const json kept = json::parse(read("bench/week-0/calibration.json"));
  EXPECT_EQ(kept["channels"][0]["fit"]["model"], "WN + RW");
  EXPECT_EQ(kept["started_ns"], std::to_string(testing::kSimulatedStart));
  EXPECT_GT(std::stoll(kept["made_ns"].get<std::string>()), 1'700'000'000'000'000'000);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "bench/week-0/calibration.json.part"));
  const json printed = json_of("calibrate bench/week-0 --model WN --no-diagnose");
  EXPECT_EQ(printed["channels"][0]["channel"], "gyro_x");
  EXPECT_EQ(json::parse(read("bench/week-0/calibration.json")), printed);
}

TEST_F(CatalogueCommands, ListsRecordingsAndCalibrations) {
  EXPECT_EQ(std::filesystem::create_directories(folder_ / "bench"), true);
  EXPECT_NE(run("recordings bench").out.find("This folder has no recordings"), std::string::npos);
  record_week(0, "4e-6");
  record_week(1, "4e-6");
  EXPECT_NE(run("calibrations bench").out.find("imunoise calibrate"), std::string::npos);
  calibrate_week(1);
  const json recordings = json_of("recordings bench");
  ASSERT_EQ(recordings["recordings"].size(), 2U);
  EXPECT_EQ(recordings["recordings"][0]["folder"], "week-0");
  EXPECT_FALSE(recordings["recordings"][0]["calibrated"].get<bool>());
  EXPECT_TRUE(recordings["recordings"][1]["calibrated"].get<bool>());
  EXPECT_EQ(recordings["recordings"][1]["replicates"], 2);
  // WN(sigma2=4e-6) at 100 Hz.
  ASSERT_EQ(recordings["recordings"][1]["noise"].size(), 1U);
  const json& n = recordings["recordings"][1]["noise"][0];
  EXPECT_EQ(n["symbol"], "N");
  EXPECT_NEAR(n["value"].get<double>(), 2e-4, 1e-5);
  EXPECT_EQ(n["datasheet_unit"], "°/√h");
  EXPECT_TRUE(recordings["recordings"][0]["noise"].empty());
  EXPECT_NE(run("recordings bench").out.find("N 0.6"), std::string::npos)
      << run("recordings bench").out;
  EXPECT_EQ(recordings["recordings"][1]["samples"], "4096");
  EXPECT_EQ(recordings["recordings"][1]["devices"][0]["id"], "simulated:0042");
  const Outcome table = run("recordings bench");
  EXPECT_NE(table.out.find("2023-11-21 22:13"), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("imu0 (0042)"), std::string::npos) << table.out;

  const json calibration = json_of("calibrations bench")["calibrations"][0];
  EXPECT_FALSE(calibration["outdated"].get<bool>());
  ASSERT_EQ(calibration["noise"].size(), 1U);
  EXPECT_EQ(calibration["noise"][0]["channel"], "gyro_x");
  EXPECT_EQ(calibration["noise"][0]["device"], "simulated:0042");
  EXPECT_EQ(calibration["noise"][0]["model"], "WN");
  EXPECT_EQ(calibration["noise"][0]["coefficients"][0]["value"], n["value"]);
  EXPECT_LT(calibration["noise"][0]["coefficients"][0]["lower"], n["value"]);
  EXPECT_NE(run("calibrations bench").out.find("N 0.6"), std::string::npos);
  record_week(1, "4e-6", 3);
  const Outcome outdated = run("calibrations bench");
  EXPECT_NE(outdated.out.find("outdated"), std::string::npos) << outdated.out;
}

TEST_F(CatalogueCommands, AHistoryRaisesTheAlarmWhenADeviceDrifts) {
  for (int week = 0; week < 6; ++week) {
    record_week(week, "4e-6");
    calibrate_week(week);
  }
  const json quiet = json_of("history bench --device 0042");
  EXPECT_FALSE(quiet["alarm"].get<bool>());
  ASSERT_EQ(quiet["parameters"].size(), 1U);
  EXPECT_EQ(quiet["parameters"][0]["parameter"], "N");
  EXPECT_EQ(quiet["parameters"][0]["points"].size(), 6U);
  EXPECT_EQ(quiet["parameters"][0]["drift"]["earlier"], 5);

  record_week(6, "8e-6");
  calibrate_week(6);
  const json drift = json_of("history bench --device imu0 --parameter N", 1);
  EXPECT_TRUE(drift["alarm"].get<bool>());
  EXPECT_NEAR(drift["parameters"][0]["drift"]["change"].get<double>(), std::sqrt(2.0) - 1.0, 0.05);
  const Outcome words = run("history bench --device 0042 --report history.html");
  EXPECT_EQ(words.status, 1);
  EXPECT_NE(words.out.find("CHANGED"), std::string::npos) << words.out;
  EXPECT_NE(words.out.find("week-6"), std::string::npos);
  EXPECT_NE(read("history.html").find("measured outside"), std::string::npos);
}

TEST_F(CatalogueCommands, TheIndexMayBeLostAndLieElsewhere) {
  record_week(0, "4e-6");
  const json before = json_of("recordings bench");
  ASSERT_TRUE(std::filesystem::remove(folder_ / "bench/catalogue.sqlite"));
  EXPECT_EQ(json_of("recordings bench"), before);
  std::filesystem::remove(folder_ / "bench/catalogue.sqlite");
  const json elsewhere = json_of("recordings bench --catalogue all.sqlite --bench north");
  EXPECT_EQ(elsewhere["recordings"][0]["bench"], "north");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "bench/catalogue.sqlite"));
  EXPECT_EQ(json_of("recordings bench --catalogue all.sqlite --bench south")["recordings"].size(),
            2U);
  EXPECT_EQ(json_of("recordings bench/week-0")["recordings"][0]["folder"], ".");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "bench/week-0/catalogue.sqlite"))
      << "nothing is put into a recording";
}

TEST_F(CatalogueCommands, SayWhatTheyCannotDo) {
  record_week(0, "4e-6");
  const auto expect = [&](const std::string& arguments, const std::string& words) {
    const Outcome done = run(arguments);
    EXPECT_NE(done.status, 0) << arguments;
    EXPECT_NE(done.errors.find(words), std::string::npos) << arguments << ": " << done.errors;
  };
  expect("calibrate absent", "absent");
  expect("calibrate bench", "is not a recording");
  expect("calibrate bench/week-0 --model WM", "WM");
  expect("calibrate bench/week-0 --channel gyro_w", "it has: gyro_x");
  expect("calibrate bench/week-0 --from 1", "are for files, not for folders");
  expect("calibrate bench/week-0 --topic a", "are for files, not for folders");
  expect("recordings absent", "absent");
  expect("recordings bench --catalogue absent/x.sqlite", "absent/x.sqlite");
  std::ofstream(folder_ / "junk.sqlite") << "this is no database, whatever its name may say";
  expect("recordings bench --catalogue junk.sqlite", "you can delete it");
  expect("history bench", "--device");
  expect("history bench --device 7", "there are simulated:0042");
  expect("history bench --device 0042", "imunoise calibrate");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "bench/week-0/calibration.json"));
}

// Two devices, left and right, with white noise of their own at the rates that are given.
void record_two(const std::filesystem::path& folder, double left_hz, double right_hz) {
  std::vector<testing::BenchDevice> devices(2);
  for (std::size_t d = 0; d < 2; ++d) {
    std::mt19937_64 random(1 + d);
    devices[d].name = d == 0 ? "left" : "right";
    devices[d].samples = 2048;
    devices[d].rate_hz = d == 0 ? left_hz : right_hz;
    std::normal_distribution<double> normal;
    devices[d].channels = {
        {"gyro_x", "rad/s", [=](std::size_t, double) mutable { return 1e-3 * normal(random); }}};
  }
  testing::record_bench(folder, 1, testing::kSimulatedStart, devices);
}

TEST_F(CatalogueCommands, AnArrayMayBeOfSeveralDevices) {
  record_two(folder_ / "two", 100.0, 100.0);
  const Outcome done = run("array two --model WN --json");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_EQ(json::parse(done.out)["sensors"], json({"left/imu/gyro_x", "right/imu/gyro_x"}));
  EXPECT_NE(done.errors.find("joined: right/imu, 100 Hz, clock +0.0 ppm, 0 samples left out"),
            std::string::npos)
      << done.errors;
  EXPECT_EQ(run("faults two --model WN --channel right/imu/gyro_x,left/imu/gyro_x").status, 0);
  const Outcome at_a_rate = run("array two --model WN --rate 50");
  EXPECT_NE(at_a_rate.status, 0);
  EXPECT_NE(at_a_rate.errors.find("are for those of one"), std::string::npos) << at_a_rate.errors;
  record_two(folder_ / "apart", 100.0, 102.4);
  const Outcome apart = run("array apart --model WN");
  EXPECT_NE(apart.status, 0);
  EXPECT_NE(apart.errors.find("rates differ"), std::string::npos) << apart.errors;
}

TEST_F(CatalogueCommands, ACalibrationComparesDevices) {
  record_two(folder_ / "two", 100.0, 100.0);
  const std::string asked = "calibrate two --model WN --no-diagnose --array --array-model WN";
  const json short_name = json_of("calibrate two --model WN --no-diagnose --channel gyro_x");
  EXPECT_EQ(short_name["channels"].size(), 2U) << "of both devices";
  const Outcome done = run(asked);
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_NE(done.out.find("20 s together"), std::string::npos) << done.out;
  const json printed = json_of(asked);
  ASSERT_EQ(printed["arrays"].size(), 1U);
  const json& array = printed["arrays"][0];
  EXPECT_EQ(array["channels"], json({"left/imu/gyro_x", "right/imu/gyro_x"}));
  EXPECT_EQ(array["report"]["pairs"][0]["dependent"], false);
  EXPECT_EQ(array["join"]["streams"][1]["dropped"], "0");
}

}  // namespace
}  // namespace imunoise
