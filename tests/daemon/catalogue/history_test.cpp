// A device's parameters over months, and the drift alarm.

#include "daemon/catalogue/history.h"

#include <gtest/gtest.h>

#include "tests/daemon/catalogue/bench_folder.h"

namespace imunoise::catalogue {
namespace {

using testing::KnownN;

class HistoryOf : public testing::BenchFolder {
 protected:
  // One calibration a week; each knows N to ±1 %.
  void add_weeks(const std::vector<double>& n, const std::string& model = "WN + RW") {
    for (const double value : n) {
      const std::string folder = "week-" + std::to_string(10 + week_);
      add_recording(folder, 7 * week_++);
      add_calibration(folder, {value, 0.99 * value, 1.01 * value}, model);
    }
  }
  Result<v1::History> history(const HistoryOptions& options = {}) const {
    auto catalogue = Catalogue::open(":memory:");
    EXPECT_TRUE(catalogue->refresh(files_, root_));
    return history_of(*catalogue->device("0042"), *catalogue->parameters("simulated:0042"),
                      options);
  }
  static const v1::ParameterHistory& n_of(const v1::History& history) {
    for (const v1::ParameterHistory& one : history.parameters()) {
      if (one.parameter() == "N") return one;
    }
    ADD_FAILURE() << "no N";
    return history.parameters(0);
  }
  int week_ = 0;
};

const std::vector<double> kQuiet = {2.00e-4, 2.01e-4, 1.99e-4, 2.005e-4, 1.995e-4, 2.00e-4};

TEST_F(HistoryOf, WhatChanceExplainsIsNoAlarm) {
  add_weeks(kQuiet);
  add_weeks({2.015e-4});
  const auto got = history();
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_FALSE(got->alarm()) << got->summary();
  EXPECT_EQ(got->device().id(), "simulated:0042");
  const v1::ParameterHistory& n = n_of(*got);
  ASSERT_EQ(n.points_size(), 7);
  EXPECT_TRUE(n.points(0).compared());
  EXPECT_EQ(n.drift().earlier(), 6U);
  EXPECT_NEAR(n.drift().change(), 0.0075, 0.001);
  EXPECT_GT(n.drift().p_value(), 0.05);
  EXPECT_LT(n.drift().expected_lower(), 1.97e-4);
  EXPECT_GT(n.drift().expected_upper(), 2.03e-4);
  EXPECT_NE(got->summary().find("compatible"), std::string::npos);
}

TEST_F(HistoryOf, AJumpIsAnAlarm) {
  add_weeks(kQuiet);
  add_weeks({2.2e-4});
  const auto got = history();
  ASSERT_TRUE(got);
  EXPECT_TRUE(got->alarm());
  const v1::ParameterHistory& n = n_of(*got);
  EXPECT_TRUE(n.drift().newest_alarm());
  EXPECT_FALSE(n.drift().trend_alarm());
  EXPECT_NEAR(n.drift().change(), 0.10, 0.005);
  EXPECT_LT(n.drift().expected_upper(), 2.2e-4);
  EXPECT_EQ(
      got->summary(),
      "Changed: gyro_x N of WN, by more than the errors and the usual scatter of this device.");
  HistoryOptions strict;
  strict.level = 1e-12;
  EXPECT_FALSE(history(strict)->alarm());
}

TEST_F(HistoryOf, ADeviceThatAlwaysScattersIsNotAccused) {
  add_weeks({2.0e-4, 2.2e-4, 1.85e-4, 2.1e-4, 1.9e-4, 2.15e-4, 2.2e-4});
  const auto got = history();
  ASSERT_TRUE(got);
  EXPECT_FALSE(got->alarm()) << got->summary();
}

TEST_F(HistoryOf, ASlowDriftIsATrend) {
  add_weeks({2.00e-4, 2.03e-4, 2.06e-4, 2.09e-4, 2.12e-4, 2.15e-4, 2.18e-4, 2.21e-4});
  const auto got = history();
  ASSERT_TRUE(got);
  EXPECT_TRUE(got->alarm());
  EXPECT_GT(n_of(*got).drift().p_value(), 1e-3) << "no single step tells";
  EXPECT_LT(n_of(*got).drift().trend_p_value(), 1e-4);
  EXPECT_NEAR(n_of(*got).drift().trend(), 0.105, 0.01);
  EXPECT_TRUE(n_of(*got).drift().trend_alarm());
  EXPECT_FALSE(n_of(*got).drift().newest_alarm());
  EXPECT_EQ(got->summary(),
            "Drifting: gyro_x N of WN, along a straight line through all calibrations.");
}

TEST_F(HistoryOf, OnlyCalibrationsOfOneModelAreCompared) {
  add_weeks({4e-4, 4.01e-4}, "WN");
  add_weeks(kQuiet);
  add_weeks({2.005e-4});
  const auto got = history();
  ASSERT_TRUE(got);
  const v1::ParameterHistory& n = n_of(*got);
  EXPECT_EQ(n.points_size(), 9);
  EXPECT_FALSE(n.points(0).compared());
  EXPECT_EQ(n.drift().earlier(), 6U);
  EXPECT_FALSE(got->alarm());
  ASSERT_EQ(got->notes_size(), 1);
  EXPECT_NE(got->notes(0).find("(WN)"), std::string::npos);
}

TEST_F(HistoryOf, ABoundIsNotCompared) {
  add_weeks(kQuiet);
  const auto got = history();
  ASSERT_TRUE(got);
  for (const v1::ParameterHistory& one : got->parameters()) {
    EXPECT_EQ(one.has_drift(), one.parameter() == "N");
  }
}

TEST_F(HistoryOf, AShortHistoryIsSaidToBeShort) {
  add_weeks({2e-4, 2e-4, 9e-4});
  const auto got = history();
  ASSERT_TRUE(got);
  EXPECT_FALSE(got->alarm());
  EXPECT_FALSE(n_of(*got).has_drift());
  EXPECT_NE(got->summary().find("Too few calibrations"), std::string::npos);
}

TEST_F(HistoryOf, TakesWhatIsAskedFor) {
  add_weeks(kQuiet);
  for (const char* const name : {"N", "WN.N", "angle random walk"}) {
    HistoryOptions options;
    options.parameters = {name};
    const auto got = history(options);
    ASSERT_TRUE(got) << got.error().message;
    ASSERT_EQ(got->parameters_size(), 1);
    EXPECT_EQ(got->parameters(0).parameter(), "N");
  }
  HistoryOptions wrong;
  wrong.parameters = {"B"};
  EXPECT_NE(history(wrong).error().message.find("there are RW.K, WN.N"), std::string::npos);
  wrong.parameters = {};
  wrong.channels = {"gyro_w"};
  EXPECT_NE(history(wrong).error().message.find("there are gyro_x"), std::string::npos);
}

// A backup beside the recordings is no further evidence.
TEST_F(HistoryOf, CopiesOfARecordingCountOnce) {
  add_weeks(kQuiet);
  for (const char* const copy : {"backup-a", "backup-b"})
    std::filesystem::copy(root_ / "week-12", root_ / copy,
                          std::filesystem::copy_options::recursive);
  const auto got = history();
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(n_of(*got).points_size(), static_cast<int>(kQuiet.size()));
}

TEST_F(HistoryOf, WithoutACalibrationThereIsNothing) {
  add_recording("monday", 0);
  const auto got = history();
  ASSERT_FALSE(got);
  EXPECT_NE(got.error().message.find("imunoise calibrate"), std::string::npos);
}

}  // namespace
}  // namespace imunoise::catalogue
